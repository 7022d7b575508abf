#include "commands/fit_json.h"

#include <algorithm>
#include <cmath>

#include "model/limits.h"
#include "pipeline/case_figures.h"

namespace aspic::cli {
namespace {

Json known(double value) { return value >= 0 && std::isfinite(value) ? Json(value) : Json(); }
Json value_or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json();
}

Json measure(const Measure& m) { return {{"name", m.name}, {"unit", m.unit}}; }

const PredictionErrors* errors_of(const std::vector<PredictionErrors>& all, const std::string& group) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const PredictionErrors& e) { return e.group == group; });
  return found == all.end() ? nullptr : &*found;
}

Json group_json(const HeldOut& g, const PredictionErrors* beyond, bool is_alone) {
  Json json = {{"group", g.group}, {"ok", g.ok}, {"failure", g.failure}};
  if (!g.ok) return json;
  for (const ReadingKind& kind : kReadingKinds) {
    const ReadingErrors& e = g.*kind.errors;
    const std::string name = kind.name;
    json[std::string("peak_") + kind.peak] = e.count > 0 ? known(e.peak) : Json();
    json[name + "_error"] = e.count > 0 ? known(e.error) : Json();
    json[name + "_noise"] = e.count > 0 ? known(e.noise) : Json();
    json[name + "_beyond_noise"] = beyond ? known(beyond->*kind.beyond_noise) : Json();
  }
  json["poor"] = beyond && beyond->is_poor(is_alone ? 1 : kSingle);
  return json;
}

}  // namespace

Json cases_json(const DataSet& data, const FitOutcome& outcome) {
  const std::vector<CaseFigures> figures = case_figures(data, outcome);
  Json list = Json::array();
  for (size_t c = 0; c < figures.size(); ++c) {
    const CaseFigures& f = figures[c];
    Json load = measure(f.load), response = measure(f.response);
    load["value"] = f.load_value;
    response["measured"] = value_or_null(f.values.measured);
    response["deviation"] = f.values.sigma;
    response["fitted"] = value_or_null(f.values.fitted);
    response["on_mesh"] = value_or_null(f.values.on_mesh);
    response["held_out"] = value_or_null(f.values.held_out);
    list.push_back({{"name", data.experiment.cases[c].name},
                    {"group", data.experiment.cases[c].group},
                    {"left_out", outcome.cases[c].left_out},
                    {"load", load},
                    {"response", response},
                    {"stiffness_unit", stiffness_unit(f)},
                    {"rms", value_or_null(f.rms)},
                    {"readings", f.readings}});
  }
  return list;
}

Json groups_json(const DataSet& data, const FitOutcome& outcome) {
  Json list = Json::array();
  for (const GroupError& e : group_errors(data, outcome))
    list.push_back({{"group", e.group}, {"readings", e.readings}, {"standard_deviations", e.sigmas}});
  return list;
}

Json histogram_json(const DataSet& data, const FitOutcome& outcome) {
  constexpr int kBins = 32;
  std::vector<int> counts(kBins, 0);
  for (size_t c = 0; c < outcome.cases.size(); ++c)
    for_each_residual(data.experiment.cases[c], outcome.cases[c], [&](double r) {
      if (std::isfinite(r))
        ++counts[static_cast<size_t>(
            std::clamp(std::floor((r + kManySigmas) / (2 * kManySigmas) * kBins), 0.0, kBins - 1.0))];
    });
  return {{"limit", kManySigmas}, {"counts", counts}};
}

Json held_out_json(const DataSet& data, const FitOutcome& outcome) {
  const std::vector<HeldOut> predicted = predicted_groups(data, outcome);
  if (predicted.empty()) return {};
  const std::vector<PredictionErrors> errors = beyond_noise(data, predicted);
  Json groups = Json::array();
  for (const HeldOut& g : predicted) groups.push_back(group_json(g, errors_of(errors, g.group), errors.size() == 1));
  const PredictionErrors all = all_groups(errors);
  Json json = {{"groups", groups}, {"poor", all.is_poor(1)}, {"limits", {{"single", kSingle}}}};
  const HeldOut largest = largest_readings(data);
  for (const ReadingKind& kind : kReadingKinds) {
    json[kind.name] = known(all.*kind.beyond_noise);
    json[std::string("largest_") + kind.peak] = known((largest.*kind.errors).peak);
    json["limits"][kind.name] = kind.limit;
  }
  return json;
}

Json comparison_json(const DataSet& data, const FitOutcome& outcome) {
  if (!outcome.held_out || outcome.held_out->groups.empty()) return Json::array();
  const auto model = [&](const std::string& name, const CrossValidation& v) {
    const PredictionErrors errors = all_groups(beyond_noise(data, v.groups));
    Json row = {{"model", name}};
    for (const ReadingKind& kind : kReadingKinds) row[kind.name] = known(errors.*kind.beyond_noise);
    return row;
  };
  const bool is_field = outcome.held_out_of_one_value.has_value();
  Json models = {model(is_field ? "this fit" : "this fit (one value per parameter)", *outcome.held_out)};
  if (is_field) models.push_back(model("one value per parameter", *outcome.held_out_of_one_value));
  return {{{"models", models}}};
}

}  // namespace aspic::cli
