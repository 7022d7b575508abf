// Pictures: curves, contour maps, surfaces over the plane; for meshes see mesh_picture.h. The program gnuplot draws
// them. The file name decides: .svg for what is read in a page, .png for what has thousands of faces. The file appears
// whole or not at all. Every function throws InvalidInput: when gnuplot is missing (naming its package), for another
// extension, when the file cannot be written.
//
// Any text may stand in titles and labels: nothing in it is taken as a command or as markup. Values that are not
// finite, or not positive on a logarithmic axis, are gaps.
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace aspic::cli {

// Throws what a function below would throw for this file name: to be asked before work whose picture is wanted.
void require_drawable(const std::filesystem::path& picture);

struct PictureSize {
  int width = 720, height = 440;  // [px] of an SVG; a PNG has twice as many, for sharp print
};

enum class AxisScale { linear, logarithmic };

struct Axis {
  std::string label;  // with the unit: "time [s]"
  AxisScale scale = AxisScale::linear;
  std::optional<double> min = {}, max = {};  // found from the data where not given
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

// z at the corners of a regular grid: z[j * nx + i] belongs to (x[i], y[j]).
struct SampledFunction {
  std::vector<double> x, y, z;
};

struct PlanarPath {
  std::string label;
  std::vector<Point2> points;         // iterates, joined by lines
  std::vector<Point2> rejected = {};  // trials that were not taken, as crosses
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
  std::optional<SampledFunction> model = {};  // a second surface over it, translucent
  std::string model_label = {};
  std::vector<MarkedPoint> points = {};
  double azimuth = 40, elevation = 35;           // of the eye [degrees]
  std::optional<double> z_min = {}, z_max = {};  // what lies outside is cut off
  PictureSize size = {700, 560};
};
void draw(const std::filesystem::path& path, const SurfacePlot& plot);

}  // namespace aspic::cli
