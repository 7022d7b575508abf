// Pictures of functions of two variables: contour maps with paths, surfaces with a model.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "aspic/gnuplot.h"
#include "base/check.h"
#include "base/error.h"

namespace aspic::cli {
namespace {

// Rows of equal y, separated by empty lines.
std::string grid_table(const SampledFunction& f) {
  ASPIC_CHECK(f.z.size() == f.x.size() * f.y.size());
  std::string text;
  for (size_t j = 0; j < f.y.size(); ++j) {
    for (size_t i = 0; i < f.x.size(); ++i) {
      append_row(text, {f.x[i], f.y[j], f.z[j * f.x.size() + i]});
    }
    text += '\n';
  }
  return text;
}

std::string point_table(const std::vector<Point2>& points) {
  std::string text;
  for (const Point2& point : points) append_row(text, {point[0], point[1]});
  return text;
}

std::vector<double> finite_sorted(const std::vector<double>& z) {
  std::vector<double> values;
  std::copy_if(z.begin(), z.end(), std::back_inserter(values), [](double v) { return std::isfinite(v); });
  std::sort(values.begin(), values.end());
  return values;
}

constexpr int kLevels = 22;

// Levels with about equal areas between them and more near the minimum, so that valleys are visible for any values.
std::vector<double> levels(const SampledFunction& f) {
  const std::vector<double> values = finite_sorted(f.z);
  if (values.empty()) throw InvalidInput("the function is nowhere finite in the requested region");
  std::vector<double> result;
  for (int k = 1; k <= kLevels; ++k) {
    const double t = std::pow(static_cast<double>(k) / (kLevels + 1), 1.6);
    const double level = values[static_cast<size_t>(t * static_cast<double>(values.size() - 1))];
    if (result.empty() || level > result.back()) result.push_back(level);
  }
  return result;
}

std::string joined(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ",") + number(value);
  return text;
}

// gnuplot's contour table contains all curves; the rank among the levels selects the color.
void add_contours(Gnuplot& plot, const SampledFunction& f) {
  const std::vector<double> at = levels(f);
  plot.add("set contour base\nset cntrparam linear\nunset surface\nset cntrparam levels discrete " + joined(at));
  plot.add(fmt::format("set table $contours\nsplot {} using 1:2:3 with lines\nunset table\nunset contour",
                       plot.data_file(grid_table(f))));
  std::string ranks = "rank(z) = 0";
  for (const double level : at) ranks += fmt::format(" + (z >= {})", number(level - 1e-9 * std::abs(level)));
  plot.add(ranks);
  plot.add(fmt::format("set cbrange [0:{}]\nunset colorbox", at.size() + 1));
  plot.add("set palette defined (0 '#2c5f8a', 0.5 '#86b3d1', 1 '#d3e3ee')");
}

}  // namespace

void draw(const std::filesystem::path& path, const ContourMap& map) {
  Gnuplot plot(path, map.size);
  const SampledFunction& f = map.function;
  plot.add("set title " + label(map.title));
  plot.add(fmt::format("set xlabel {}\nset ylabel {}", label(map.x_label), label(map.y_label)));
  plot.add("set border 15\nset size ratio -1");
  add_contours(plot, f);
  plot.add(fmt::format("set xrange {}\nset yrange {}", range(f.x.front(), f.x.back()), range(f.y.front(), f.y.back())));
  std::string layers = "plot $contours using 1:2:(rank($3)) with lines lw 1 lc palette notitle";
  constexpr size_t kMarked = 100;  // marks of a path; more would hide it
  bool has_rejected = false, has_start = false;
  int next = 1;  // blue is reserved for contours
  for (const PlanarPath& line : map.paths) {
    const std::string ink = color(next);
    const std::string marks =
        fmt::format("linespoints pt {} pi {} ps 0.45 lw", mark(next - 1), 1 + line.points.size() / kMarked);
    next = next % 6 + 1;
    if (!line.rejected.empty())
      layers += fmt::format(", {} using 1:2 with points pt 2 ps 0.5 lw 1 lc rgb {} {}",
                            plot.data_file(point_table(line.rejected)), ink,
                            std::exchange(has_rejected, true) ? "notitle" : "title " + label("rejected trials"));
    layers += fmt::format(", {} using 1:2 with {} lc rgb {} title {}", plot.data_file(point_table(line.points)),
                          marks + (line.points.size() > kMarked ? " 1" : " 1.6"), ink, label(line.label));
    if (!line.points.empty())  // initial guess
      layers += fmt::format(", {} using 1:2 with points pt 6 ps 1.1 lw 1.6 lc rgb {} {}",
                            plot.data_file(point_table({line.points.front()})), ink,
                            std::exchange(has_start, true) ? "notitle" : "title 'start'");
  }
  if (map.minimizer)
    layers += fmt::format(", {} using 1:2 with points pt 3 ps 1.2 lw 1.8 lc rgb '#111111' title 'minimum'",
                          plot.data_file(point_table({*map.minimizer})));
  plot.add(layers);
  plot.draw();
}

void draw(const std::filesystem::path& path, const SurfacePlot& surface) {
  Gnuplot plot(path, surface.size);
  const SampledFunction& f = surface.function;
  const std::vector<double> values = finite_sorted(f.z);
  if (values.empty()) throw InvalidInput(path.string() + ": the function is nowhere finite in this region");
  const double low = surface.z_min.value_or(values.front()), high = surface.z_max.value_or(values.back());
  plot.add("set title " + label(surface.title));
  plot.add(fmt::format("set xlabel {}\nset ylabel {}", label(surface.x_label), label(surface.y_label)));
  plot.add(fmt::format("set zlabel {} rotate", label(surface.z_label)));
  plot.add(fmt::format("set view {},{}\nset xyplane relative 0.02", number(90 - surface.elevation),
                       number(surface.azimuth)));
  plot.add("set pm3d clip z depthorder base lighting primary 0.4 specular 0.15 border lc rgb '#90203040' lw 0.3");
  plot.add("set key at screen 0.52, 0.085 center center horizontal width -2 maxrows 2");
  plot.add("set xtics offset -0.8,-0.2\nset ytics offset 0.8,-0.2");  // the last ones meet in a corner
  plot.add("set palette defined (0 '#2c5f8a', 0.4 '#7fb0cf', 1 '#f2f6f9')\nunset colorbox");
  plot.add(
      fmt::format("set border 127+256+512 lc rgb '#9a9a9a' lw 0.6\nset grid x y z lc rgb '{}' lw 0.6 lt 1", kGrid));
  plot.add(fmt::format("set xrange {}\nset yrange {}", range(f.x.front(), f.x.back()), range(f.y.front(), f.y.back())));
  plot.add(fmt::format("set zrange {0}\nset cbrange {0}", range(low, high)));
  std::string layers = fmt::format("splot {} using 1:2:3 with pm3d notitle", plot.data_file(grid_table(f)));
  if (surface.model)
    layers += fmt::format(
        ", NaN with points pt 5 ps 1.6 lc rgb '#7fb0cf' title {}"
        ", {} every 2:2 using 1:2:3 with lines lw 0.8 lc rgb '#e69f00' title {}",
        label(surface.z_label), plot.data_file(grid_table(*surface.model)), label(surface.model_label));
  int next = 1;
  for (const MarkedPoint& point : surface.points) {  // labels, because surfaces could hide points
    const std::string mark = fmt::format("pt 7 ps 1.1 lc rgb {}", color(next++));
    plot.add(fmt::format("set label '' at {}, {}, {} front point {}", number(point.x), number(point.y), number(point.z),
                         mark));
    layers += fmt::format(", NaN with points {} title {}", mark, label(point.label));
  }
  plot.add(layers);
  plot.draw();
}

}  // namespace aspic::cli
