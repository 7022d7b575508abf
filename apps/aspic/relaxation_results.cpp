#include "aspic/relaxation_results.h"

#include <fmt/format.h>

#include "aspic/plot.h"
#include "base/error.h"
#include "capture/relaxation.h"
#include "io/atomic_file.h"
#include "io/csv.h"

namespace aspic::cli {
namespace {

std::string range_text(const Interval& interval, const char* unit) {
  return fmt::format("(95 %: {:.4g} to {:.4g}{})", interval.lower, interval.upper, unit);
}

void draw_curves(const std::filesystem::path& path, const RelaxationFit& fit) {
  Chart chart{.title = "Relaxation",
              .x = {.label = "time [s]", .scale = AxisScale::logarithmic},
              .y = {.label = "force [N]"},
              .series = {}};
  for (size_t h = 0; h < fit.curves.size(); ++h) {
    const HistoryCurve& curve = fit.curves[h];
    if (curve.measured.empty()) continue;
    const int color = static_cast<int>(h);
    Series measured{.label = curve.name + ", measured", .style = SeriesStyle::points, .color = color};
    Series fitted{.label = curve.name + ", fitted", .color = color};
    for (size_t k = 0; k < curve.measured.size(); ++k) {
      measured.x.push_back(curve.measured[k].time), measured.y.push_back(curve.measured[k].value);
      fitted.x.push_back(curve.measured[k].time), fitted.y.push_back(curve.fitted[k]);
    }
    chart.series.push_back(std::move(measured));
    chart.series.push_back(std::move(fitted));
  }
  try {
    if (!chart.series.empty()) draw(path, chart);
  } catch (const InvalidInput& missing) {
    fmt::print(stderr, "note: no picture: {}\n", missing.what());
  }
}

}  // namespace

void print_relaxation(std::FILE* stream, const RelaxationFit& fit) {
  if (!fit.is_ok()) return;
  fmt::print(stream, "relaxation |r|^2 = {:.3g} per reading of {}; stiffness times {:.4g} {}\n",
             fit.squares / fit.residuals, fit.residuals, fit.scale, range_text(fit.scale_interval, ""));
  for (const FittedBranch& b : fit.branches)
    fmt::print(stream, "           {:.4g} s {}: ratio {:.4g} {}, {:.3g} % of the shear modulus for fast loads\n",
               b.time, range_text(b.time_interval, " s"), b.ratio, range_text(b.ratio_interval, ""), 100 * b.fraction);
  for (const BranchTrial& trial : fit.trials)
    if (fit.trials.size() > 1)
      fmt::print(stream, "           {} branches: {}\n", trial.count,
                 trial.failure.empty() ? fmt::format("|r|^2 = {:.3g} per reading, log evidence {:.4g}",
                                                     trial.squares / fit.residuals, trial.evidence)
                                       : trial.failure);
}

nlohmann::ordered_json json_of(const RelaxationFit& fit) {
  nlohmann::ordered_json json = {{"ok", fit.is_ok()}, {"failure", fit.failure}};
  if (!fit.is_ok()) return json;
  const auto bounds = [](const Interval& i) { return nlohmann::ordered_json{{"lower", i.lower}, {"upper", i.upper}}; };
  json["squares_per_reading"] = fit.squares / fit.residuals;
  json["readings"] = fit.residuals;
  json["noise_factor"] = fit.noise_factor;
  json["scale"] = {{"value", fit.scale}, {"lower", fit.scale_interval.lower}, {"upper", fit.scale_interval.upper}};
  json["branches"] = nlohmann::ordered_json::array();
  for (const FittedBranch& b : fit.branches)
    json["branches"].push_back({{"ratio", b.ratio},
                                {"ratio_interval", bounds(b.ratio_interval)},
                                {"relaxation_time", b.time},
                                {"time_interval", bounds(b.time_interval)},
                                {"fraction", b.fraction}});
  json["trials"] = nlohmann::ordered_json::array();
  for (const BranchTrial& trial : fit.trials)
    json["trials"].push_back({{"branches", trial.count},
                              {"failure", trial.failure},
                              {"squares_per_reading", trial.squares / fit.residuals},
                              {"log_evidence", trial.evidence}});
  json["curves"] = nlohmann::ordered_json::array();
  for (const HistoryCurve& curve : fit.curves) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (size_t k = 0; k < curve.measured.size(); ++k)
      points.push_back({{"time", curve.measured[k].time},
                        {"measured", curve.measured[k].value},
                        {"sd", curve.measured[k].sigma},
                        {"fitted", curve.fitted[k]}});
    json["curves"].push_back({{"name", curve.name}, {"points", points}});
  }
  return json;
}

void write_relaxation(const std::filesystem::path& folder, const RelaxationFit& fit) {
  if (!fit.is_ok()) return;
  write_file(folder / "viscoelastic.toml", scene_text(fit));
  CsvFile file = CsvFile::create(folder / "relaxation.csv", {"history", "time", "measured", "sd", "fitted"});
  for (const HistoryCurve& curve : fit.curves)
    for (size_t k = 0; k < curve.measured.size(); ++k) {
      CsvRow row;
      row.add(curve.name).add(curve.measured[k].time).add(curve.measured[k].value);
      row.add(curve.measured[k].sigma).add(curve.fitted[k]);
      file.append(row);
    }
  file.close();
  draw_curves(folder / "relaxation.svg", fit);
}

}  // namespace aspic::cli
