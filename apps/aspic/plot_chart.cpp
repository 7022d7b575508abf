// Charts of curves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "aspic/gnuplot.h"
#include "base/check.h"

namespace aspic::cli {
namespace {

bool is_drawable(double value, const Axis& axis) {
  return std::isfinite(value) && (axis.scale == AxisScale::linear || value > 0);
}

struct Range {
  double min = INFINITY, max = -INFINITY;
};

// Range of the points that can be drawn.
std::array<Range, 2> data_ranges(const Chart& chart) {
  std::array<Range, 2> ranges;
  for (const Series& series : chart.series)
    for (size_t i = 0; i < series.x.size(); ++i) {
      if (!is_drawable(series.x[i], chart.x) || !is_drawable(series.y[i], chart.y)) continue;
      for (auto& [range, value] : {std::pair(&ranges[0], series.x[i]), std::pair(&ranges[1], series.y[i])})
        range->min = std::min(range->min, value), range->max = std::max(range->max, value);
    }
  return ranges;
}

void add_axis(Gnuplot& plot, char name, Axis axis, const Range& data) {
  const bool logarithmic = axis.scale == AxisScale::logarithmic, empty = !(data.min <= data.max);
  if (empty) {  // gnuplot computes no range without data
    if (!axis.min) axis.min = logarithmic ? 0.1 : 0.0;
    if (!axis.max) axis.max = std::max(1.0, 2 * *axis.min);
  } else if (logarithmic) {  // avoids rounding to whole decades
    if (!axis.min) axis.min = data.min / 1.6;
    if (!axis.max) axis.max = data.max * 1.6;
  }
  plot.add(fmt::format("set {}label {}", name, label(axis.label)));
  if (logarithmic) plot.add(fmt::format("set logscale {0} 10\nset format {0} '10^{{%T}}'", name));
  plot.add(fmt::format("set {}range {}", name, range(axis.min, axis.max)));
}

std::string style(const Series& series, int color_index) {
  const std::string with_color = fmt::format("lc rgb {}", color(color_index));
  switch (series.style) {
    case SeriesStyle::line:
      return fmt::format("with lines lw 1.8 {}", with_color);
    case SeriesStyle::dashed:
      return fmt::format("with lines lw 1.4 dt (9,6) {}", with_color);
    case SeriesStyle::points:
      return fmt::format("with points pt {} ps 0.6 {}", mark(color_index), with_color);
    case SeriesStyle::line_and_points:
      return fmt::format("with linespoints lw 1.5 pt {} ps 0.6 {}", mark(color_index), with_color);
  }
  return "";
}

std::string table(const Series& series, const Chart& chart) {
  std::string text;
  for (size_t i = 0; i < series.x.size(); ++i)
    append_row(text, {is_drawable(series.x[i], chart.x) ? series.x[i] : NAN,
                      is_drawable(series.y[i], chart.y) ? series.y[i] : NAN});
  return text.empty() ? "NaN NaN\n" : text;
}

}  // namespace

void draw(const std::filesystem::path& path, const Chart& chart) {
  Gnuplot plot(path, chart.size);
  const auto [x_data, y_data] = data_ranges(chart);
  plot.add("set title " + label(chart.title));
  plot.add(fmt::format("set grid lc rgb '{}' lw 0.8 lt 1", kGrid));
  if (chart.series.size() > 6) plot.add(fmt::format("set key maxrows {} font ',10'", (chart.series.size() + 2) / 3));
  add_axis(plot, 'x', chart.x, x_data);
  add_axis(plot, 'y', chart.y, y_data);
  std::string curves;
  int next = 0;
  for (const Series& series : chart.series) {
    ASPIC_CHECK(series.x.size() == series.y.size());
    const int color_index = series.color >= 0 ? series.color : next++;
    curves +=
        fmt::format("{}{} using 1:2 {} {}", curves.empty() ? "" : ", ", plot.data_file(table(series, chart)),
                    style(series, color_index), series.label.empty() ? "notitle" : "title " + label(series.label));
  }
  plot.add("plot " + (curves.empty() ? "NaN notitle" : curves));
  plot.draw();
}

}  // namespace aspic::cli
