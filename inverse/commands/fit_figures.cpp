#include "commands/fit_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "commands/fit_json.h"
#include "commands/fit_summary.h"
#include "commands/law_table.h"
#include "commands/relaxation_results.h"
#include "model/quantity.h"
#include "pipeline/left_out.h"

namespace aspic::cli {
namespace {

std::string percent(double part) { return fmt::format("{:.3g} %", 100 * part); }

void print_judgment(std::FILE* stream, const Judgment& j) {
  if (!j.is_log)
    fmt::print(stream, "truth      {}: error {:.3g} (root mean square)\n", j.quantity, j.error);
  else
    fmt::print(stream, "truth      {}: error {} (root mean square of its logarithm{}), largest a factor of {:.3g}\n",
               j.quantity, percent(j.error),
               j.relative_error < 0 ? "" : "; " + percent(j.relative_error) + " of its variation", std::exp(j.largest));
  if (j.phases.size() > 1)
    for (const Phase& p : j.phases)
      fmt::print(stream, "           {:.4g} where it is {:.4g}, {} of the body\n", p.fitted, p.truth, percent(p.share));
  if (j.phases.size() > 1)
    fmt::print(stream, "           contrast {:.3g} of {:.3g}{}\n", j.contrast(), j.true_contrast(),
               j.overlap < 0
                   ? ""
                   : fmt::format(", overlap of the smaller part {} (intersection over union)", percent(j.overlap)));
  if (j.coverage >= 0)
    fmt::print(stream, "           in {} of the tets the 95 % interval contains the truth\n", percent(j.coverage));
}

void print_left_out(std::FILE* stream, const DataSet& data, const HeldOut& h) {
  if (!h.ok)
    fmt::print(stream, "left out   no prediction: {}\n", h.failure);
  else
    fmt::print(stream, "left out   {}, beyond the noise\n", errors_text(all_groups(beyond_noise(data, {h})), 0));
}

Json json_of(const Judgment& j) {
  Json phases = Json::array();
  for (const Phase& p : j.phases) phases.push_back({{"share", p.share}, {"truth", p.truth}, {"fitted", p.fitted}});
  return {{"quantity", j.quantity},
          {"error", j.error},
          {"relative_error", j.relative_error},
          {"largest", j.largest},
          {"level", j.level},
          {"coverage", j.coverage},
          {"contrast", j.contrast()},
          {"true_contrast", j.true_contrast()},
          {"overlap", j.overlap},
          {"phases", phases}};
}

Json json_of(const HeldOut& h) {
  if (!h.ok) return {{"ok", false}, {"failure", h.failure}};
  Json json = {{"ok", true}};
  for (const ReadingKind& kind : kReadingKinds) {
    const ReadingErrors& e = h.*kind.errors;
    json[std::string("peak_") + kind.peak] = e.peak;
    json[std::string(kind.name) + "_error"] = e.error;
    json[std::string(kind.name) + "_noise"] = e.noise;
  }
  return json;
}

Json json_of(const FitVerdict& judged) {
  Json reasons = Json::array();
  for (const FitReason& reason : judged.reasons) {
    Json json = {{"name", reason.name}, {"text", reason.text}};
    if (reason.value) json["value"] = *reason.value;
    if (reason.limit) json["limit"] = *reason.limit;
    reasons.push_back(json);
  }
  return {{"good", judged.is_good()}, {"text", judged.text}, {"reasons", reasons}};
}

Json values_of(const FitOutcome& outcome) {
  Json values = Json::object();
  for (const FittedQuantity& q : outcome.quantities)
    for (const ValueRow& row : q.rows) {
      Json value = {{"value", row.value}};
      if (row.interval) value["lower"] = row.interval->lower, value["upper"] = row.interval->upper;
      values[q.name][row.where] = value;
    }
  return values;
}

Json parts_of(const FoundParts& found) {
  Json json = {{"kept", found.are_kept}, {"volumes", found.volume}};
  if (!found.are_kept) return json;
  json["contrast"] = {{"value", found.values.back() / found.values.front()}};
  if (found.contrast) json["contrast"].update({{"lower", found.contrast->lower}, {"upper", found.contrast->upper}});
  return json;
}

Json fibres_of(const FitOutcome& outcome) {
  const auto axis = [](const Vec3d& a) { return Json{a[0], a[1], a[2]}; };
  Json fibres = Json::array();
  for (const FoundFibres& f : outcome.fibres) {
    Json found = {{"where", f.where}, {"direction", axis(f.direction)}, {"others", Json::array()}};
    if (f.cone >= 0) found["cone_95"] = f.cone;
    for (const Vec3d& other : f.others) found["others"].push_back(axis(other));
    fibres.push_back(std::move(found));
  }
  return fibres;
}

Json errors_of(const FitOutcome& outcome) {
  Json errors = Json::array();
  for (const EstimatedError& e : outcome.errors) {
    Json error = {{"name", e.name}, {"unit", e.unit}, {"value", e.value}, {"prior_deviation", e.prior_sigma}};
    if (e.sigma >= 0) error["deviation"] = e.sigma, error["determined_by"] = e.is_from_data() ? "data" : "prior";
    if (e.stated) error["coefficient"] = e.coefficient();
    if (e.stated && e.sigma >= 0) error["coefficient_95"] = {e.coefficient(-kSigmas95), e.coefficient(kSigmas95)};
    errors.push_back(std::move(error));
  }
  return errors;
}

Json outliers_of(const FitOutcome& outcome) {
  Json outliers = Json::array();
  for (const Outlier& o : outcome.outliers)
    outliers.push_back({{"case", o.load_case}, {"reading", o.reading}, {"weight", o.weight}});
  return outliers;
}

}  // namespace

FitFigures figures_of(const DataSet& data, const FitOutcome& outcome, const std::filesystem::path& truth) {
  FitFigures figures;
  std::error_code error;
  if (std::filesystem::exists(truth, error)) figures.judgments = judge(outcome.material, read_material(truth));
  if (!left_out_cases(data, outcome.plan).cases.empty()) figures.left_out = compare_held_out(data, outcome);
  return figures;
}

void print_figures(std::FILE* stream, const DataSet& data, const FitFigures& figures) {
  for (const Judgment& j : figures.judgments) print_judgment(stream, j);
  if (figures.left_out) print_left_out(stream, data, *figures.left_out);
}

std::string figures_json(const DataSet& data, const FitOutcome& outcome, const FitVerdict& judged,
                         const FitFigures& figures) {
  const FitReport& report = outcome.report;
  Json json = {{"converged", is_success(report.status)},
               {"words", report.message},
               {"verdict", json_of(judged)},
               {"unknowns", outcome.parameter_count},
               {"residuals", outcome.residuals},
               {"iterations", report.iterations},
               {"equilibria", outcome.counts.equilibria},
               {"weight", report.weight},
               {"squares", 2 * report.misfit},
               {"values", values_of(outcome)},
               {"warnings", outcome.warnings}};
  if (outcome.parts) json["parts"] = parts_of(*outcome.parts);
  if (!outcome.fibres.empty()) json["fibres"] = fibres_of(outcome);
  if (!outcome.errors.empty()) json["errors"] = errors_of(outcome);
  for (const FoundCommonError& e : outcome.common_errors)
    json["common_errors"].push_back({{"cause", e.cause}, {"standard_deviations", e.sigmas}});
  if (outcome.plan.robust) json["outliers"] = outliers_of(outcome);
  if (outcome.uniform) json["squares_of_one_value"] = 2 * outcome.uniform->misfit;
  if (outcome.posterior && outcome.posterior->ok)
    json["posterior"] = {{"informed", outcome.posterior->informed},
                         {"noise_factor", outcome.posterior->noise_factor},
                         {"suggested_weight", outcome.posterior->suggested_weight},
                         {"scale_is_unknown", outcome.posterior->scale_is_unknown}};
  if (outcome.law_choice) json["laws"] = json_of(*outcome.law_choice);
  if (outcome.relaxation) json["relaxation"] = json_of(*outcome.relaxation);
  json["truth"] = Json::array();
  for (const Judgment& j : figures.judgments) json["truth"].push_back(json_of(j));
  json["left_out"] = Json::object();
  if (figures.left_out) json["left_out"]["fit"] = json_of(*figures.left_out);
  json["limits"] = {{"missed", kManySigmas}, {"squares_per_reading", kTooManySquares}};
  json["groups"] = groups_json(data, outcome);
  json["held_out"] = held_out_json(data, outcome);
  json["comparison"] = comparison_json(data, outcome);
  json["cases"] = cases_json(data, outcome);
  json["histogram"] = histogram_json(data, outcome);
  return json.dump(1) + "\n";
}

}  // namespace aspic::cli
