#include "commands/relaxation_results.h"

#include <fmt/format.h>

#include "aspic/plot.h"
#include "base/error.h"
#include "io/atomic_file.h"
#include "io/csv.h"
#include "pipeline/relaxation.h"

namespace aspic::cli {
namespace {

std::string range_text(const Interval& interval, const char* unit) {
  return fmt::format("(95 %: {:.4g} to {:.4g}{})", interval.lower, interval.upper, unit);
}

// Draws the curves of one unit, if there are any.
void draw_curves(const std::filesystem::path& path, const RelaxationFit& fit, const std::string& unit) {
  Chart chart{.title = unit == "N" ? "Relaxation" : "Creep",
              .x = {.label = "time [s]", .scale = AxisScale::logarithmic},
              .y = {.label = unit == "N" ? "force [N]" : "motion [m]"},
              .series = {}};
  for (size_t h = 0; h < fit.curves.size(); ++h) {
    const HistoryCurve& curve = fit.curves[h];
    if (curve.unit != unit) continue;
    const int color = static_cast<int>(h);
    const std::string name = curve.history + ", " + curve.reading;
    Series measured{.label = name + ", measured", .style = SeriesStyle::points, .color = color};
    Series fitted{.label = name + ", fitted", .color = color};
    for (const HistoryPoint& p : curve.points) {
      if (!(p.time > 0)) continue;
      measured.x.push_back(p.time), measured.y.push_back(p.measured);
      fitted.x.push_back(p.time), fitted.y.push_back(p.fitted);
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
  fmt::print(stream, "relaxation |r|^2 = {:.3g} per reading of {}; {}\n", fit.squares / fit.residuals, fit.residuals,
             fit.scale_sigma > 0 ? fmt::format("the stiffness above includes their factor {:.4g} {}", fit.scale,
                                               range_text(fit.scale_interval, ""))
                                 : "with the given stiffness");
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
  json["scale"] = {{"value", fit.scale},
                   {"lower", fit.scale_interval.lower},
                   {"upper", fit.scale_interval.upper},
                   {"known", fit.scale_sigma == 0}};
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
    for (const HistoryPoint& p : curve.points)
      points.push_back({{"time", p.time}, {"measured", p.measured}, {"sd", p.sigma}, {"fitted", p.fitted}});
    json["curves"].push_back(
        {{"name", curve.history}, {"reading", curve.reading}, {"unit", curve.unit}, {"points", points}});
  }
  return json;
}

void write_relaxation(const std::filesystem::path& folder, const RelaxationFit& fit) {
  if (!fit.is_ok()) return;
  write_file(folder / "viscoelastic.toml", scene_text(fit));
  CsvFile file =
      CsvFile::create(folder / "relaxation.csv", {"history", "reading", "unit", "time", "measured", "sd", "fitted"});
  for (const HistoryCurve& curve : fit.curves)
    for (const HistoryPoint& p : curve.points) {
      CsvRow row;
      row.add(curve.history).add(curve.reading).add(curve.unit);
      row.add(p.time).add(p.measured).add(p.sigma).add(p.fitted);
      file.append(row);
    }
  file.close();
  draw_curves(folder / "relaxation.svg", fit, "N");
  draw_curves(folder / "creep.svg", fit, "m");
}

}  // namespace aspic::cli
