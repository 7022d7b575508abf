// Pictures of curves, contour maps and surfaces, drawn by gnuplot; for meshes see mesh_picture.h. The extension selects
// the format: .svg for pages, .png for pictures with thousands of faces. Files are written atomically. All functions
// throw InvalidInput for other extensions, if gnuplot is missing (with the name of its package), or if the file cannot
// be written. Titles and labels may contain any text; it is never interpreted as commands or markup. Values that are
// not finite, or not positive on a logarithmic axis, are gaps.
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace aspic::cli {

// Throws InvalidInput if this picture cannot be drawn. Call it before long work.
void require_drawable(const std::filesystem::path& picture);

struct PictureSize {
  int width = 720, height = 440;  // size of an SVG [px]; a PNG has twice as many pixels, for sharp print
};

enum class AxisScale { linear, logarithmic };

struct Axis {
  std::string label;  // with the unit: "time [s]"
  AxisScale scale = AxisScale::linear;
  std::optional<double> min = {}, max = {};  // default: range of the data
};

enum class SeriesStyle { line, dashed, points, line_and_points };

struct Series {
  std::string label;  // empty: not in the legend
  std::vector<double> x, y;
  SeriesStyle style = SeriesStyle::line;
  int color = -1;  // index into the palette; -1: the next one
};

struct Chart {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  PictureSize size = {};
};
void draw(const std::filesystem::path& path, const Chart& chart);

using Point2 = std::array<double, 2>;

// Values z at the points of a regular grid: z[j * nx + i] belongs to (x[i], y[j]).
struct SampledFunction {
  std::vector<double> x, y, z;
};

struct PlanarPath {
  std::string label;
  std::vector<Point2> points;         // iterates, joined by lines
  std::vector<Point2> rejected = {};  // rejected trials, drawn as crosses
};

struct ContourMap {
  std::string title, x_label = "x", y_label = "y";
  SampledFunction function;
  std::vector<PlanarPath> paths;
  std::optional<Point2> minimizer = {};  // drawn as a star
  PictureSize size = {620, 560};
};
void draw(const std::filesystem::path& path, const ContourMap& map);

struct MarkedPoint {
  std::string label;
  double x = 0, y = 0, z = 0;
};

struct SurfacePlot {
  std::string title, x_label = "x", y_label = "y", z_label = "z";
  SampledFunction function;
  std::optional<SampledFunction> model = {};  // drawn as a grid of lines
  std::string model_label = {};
  std::vector<MarkedPoint> points = {};
  double azimuth = 40, elevation = 35;           // view direction [degrees]
  std::optional<double> z_min = {}, z_max = {};  // values outside are clipped
  PictureSize size = {700, 560};
};
void draw(const std::filesystem::path& path, const SurfacePlot& plot);

}  // namespace aspic::cli
