#include "aspic/landscape_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aspic::cli {
namespace {

std::string title(const Landscape& landscape) {
  return fmt::format("step {}, iteration {}", landscape.at.step, landscape.at.iteration);
}

// Range from just below the minimum of model and accepted trial to just above the start and lowest rejected trial.
Axis value_axis(const Landscape& landscape) {
  double lowest = landscape.value, highest = landscape.value, rejected = INFINITY;
  for (const CurvePoint& point : landscape.curve) {
    lowest = std::min(lowest, point.model);
    if (std::isfinite(point.value)) lowest = std::min(lowest, point.value);
  }
  for (const Trial& trial : landscape.tried)
    if (!trial.accepted && std::isfinite(trial.value)) rejected = std::min(rejected, trial.value);
  if (std::isfinite(rejected)) highest = std::max(highest, rejected);
  const double margin = 0.5 * (landscape.value - lowest);
  return {.label = "E", .min = lowest - 0.2 * margin, .max = highest + margin};
}

}  // namespace

Chart line_search_chart(const Landscape& landscape) {
  Series value{"E(x + alpha d)"}, model{"quadratic model"}, rejected{"rejected"}, accepted{"accepted"};
  Series textbook{"E + c alpha d'g (textbook)"}, slide{"E + c d'g (slide)"};
  textbook.style = slide.style = SeriesStyle::dashed;
  rejected.style = accepted.style = SeriesStyle::points;
  const auto add = [](Series& series, double x, double y) { series.x.push_back(x), series.y.push_back(y); };
  for (const CurvePoint& point : landscape.curve) {
    add(value, point.alpha, point.value);
    add(model, point.alpha, point.model);
    add(textbook, point.alpha, point.textbook_bound);
    add(slide, point.alpha, point.slide_bound);
  }
  for (const Trial& trial : landscape.tried) add(trial.accepted ? accepted : rejected, trial.alpha, trial.value);
  std::vector<Series> series = {value, model, textbook, slide, accepted};
  if (!rejected.x.empty()) series.push_back(rejected);
  return {.title = "Line search: " + title(landscape),
          .x = {.label = "alpha"},
          .y = value_axis(landscape),
          .series = std::move(series)};
}

SurfacePlot slice_surface(const Landscape& landscape) {
  const Slice& slice = landscape.slice;
  SampledFunction value;
  for (int i = 0; i < slice.columns; ++i) value.x.push_back(slice.point[i].s);
  for (int j = 0; j < slice.rows; ++j) value.y.push_back(slice.point[static_cast<size_t>(j) * slice.columns].t);
  SampledFunction model = value;
  double lowest = 0, highest = 0;  // range of the model, because E may be unbounded
  for (const SlicePoint& point : slice.point) {
    value.z.push_back(point.value - landscape.value);
    model.z.push_back(point.model - landscape.value);
    lowest = std::min({lowest, model.z.back(), value.z.back()});
    highest = std::max(highest, model.z.back());
  }
  SurfacePlot plot{.title = "E over the plane through d: " + title(landscape),
                   .x_label = "s, along d",
                   .y_label = "t, across",
                   .z_label = "E - E(x)",
                   .function = std::move(value),
                   .model = std::move(model),
                   .model_label = "quadratic model",
                   .points = {{"x", 0, 0, 0}},
                   .z_min = lowest - 0.02 * (highest - lowest),
                   .z_max = highest + 0.1 * (highest - lowest)};
  for (const Trial& trial : landscape.tried)
    if (trial.accepted) plot.points.push_back({"accepted", trial.alpha, 0, trial.value - landscape.value});
  return plot;
}

}  // namespace aspic::cli
