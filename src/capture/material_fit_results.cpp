#include <algorithm>
#include <limits>

#include "capture/fit_troubles.h"
#include "capture/fitted_values.h"
#include "capture/material_fit.h"

namespace aspic {

void MaterialFit::learn_uncertainty(FitModel& model) {
  if (!plan_.uncertainty || !may_go_on()) return;
  begin(FitStage::uncertainty, "what the data do not say");
  const FitReport& report = outcome_.report;
  WithUncertainLayers about_fit(model.recorded());
  outcome_.posterior = posterior(about_fit, *model.prior, report.weight, model.map, mesh(), report.p);
  add_warnings(outcome_.posterior->warnings);
}

// The material of p, its values for people, and what it predicts for the cases that were fitted.
void MaterialFit::describe(FitModel& model, std::span<const double> p) {
  const Posterior* belief = outcome_.posterior && outcome_.posterior->ok ? &*outcome_.posterior : nullptr;
  outcome_.quantities = fitted_quantities(model.map, mesh(), p, belief);
  outcome_.material = fitted_material(data_, model.map, p, outcome_.quantities);
  outcome_.counts = model.misfit.counts();
  outcome_.cases.resize(data_.experiment.cases.size());
  std::vector<double> r(static_cast<size_t>(model.misfit.residual_count()));
  if (model.journal) model.journal->catch_up();
  const bool ok = model.misfit.evaluate(p, r);
  model.with_layers->errors().apply(r);
  if (ok)
    if (const std::string words = words_of_worst_row(data_, plan_.left_out, model.misfit, r); !words.empty())
      add_warnings({words});
  int fitted = 0;
  for (size_t c = 0; c < outcome_.cases.size(); ++c) {
    CaseOutcome& outcome = outcome_.cases[c];
    outcome.left_out = is_left_out(plan_.left_out, data_.experiment.cases[c]);
    if (outcome.left_out) continue;
    const CasePrediction& on_mesh = model.misfit.prediction(fitted++);
    if (!ok) continue;
    CasePrediction prediction = simulated_.on_finer_mesh(c, on_mesh);
    outcome.ok = true;
    outcome.markers = std::move(prediction.markers);
    outcome.wrench = prediction.wrench;
  }
}

// The cases of a group as a material predicts them.
void MaterialFit::predict_group(const std::string& group, const ParameterMap& map, std::span<const double> p,
                                const UsePrediction& use) {
  const Experiment part = subset(simulated_.all(), [&](const LoadCase& c) { return c.group == group; });
  Misfit misfit(part, map, plan_.equilibrium);
  std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
  if (!misfit.evaluate(p, r)) return add_warnings({"'" + group + "' could not be predicted: " + misfit.failure()});
  int own = 0;
  for (size_t c = 0; c < data_.experiment.cases.size(); ++c)
    if (data_.experiment.cases[c].group == group)
      use(outcome_.cases[c], simulated_.on_finer_mesh(c, misfit.prediction(own++)));
}

void MaterialFit::predict_left_out(const ParameterMap& map, std::span<const double> p) {
  for (const std::string& group : plan_.left_out)
    predict_group(group, map, p, [](CaseOutcome& outcome, const CasePrediction& prediction) {
      outcome.ok = outcome.has_held_out = true;
      outcome.markers = outcome.held_out_markers = prediction.markers;
      outcome.wrench = outcome.held_out_wrench = prediction.wrench;
    });
}

void MaterialFit::cross_validate_groups(FitModel& model) {
  if (!plan_.cross_validation || !may_go_on()) return;
  // A fit stops at its deadline: that comes when the witness wants no more.
  const WallClock clock = [&] { return may_go_on() ? 0.0 : std::numeric_limits<double>::infinity(); };
  FitOptions options = plan_.fit;
  options.deadline = Deadline(clock, 1);
  const auto observe = [&](int group, int groups, const std::string& name) {
    begin(FitStage::cross_validation,
          "'" + name + "' is left out (" + std::to_string(group + 1) + " of " + std::to_string(groups) + ")");
    return may_go_on();
  };
  CrossValidation held_out = cross_validate(simulated_.fitted(), model.map, *model.prior, outcome_.report, options,
                                            plan_.equilibrium, observe);
  if (outcome_.interrupted) return;  // the last group is not to be trusted
  add_warnings(held_out.warnings);
  for (const HeldOut& group : held_out.groups)
    if (group.ok)
      predict_group(group.group, model.map, group.p, [](CaseOutcome& outcome, const CasePrediction& prediction) {
        outcome.has_held_out = true;
        outcome.held_out_markers = prediction.markers;
        outcome.held_out_wrench = prediction.wrench;
      });
  outcome_.held_out = std::move(held_out);
}

void MaterialFit::find_next_poke(FitModel& model) {
  const std::vector<LoadCase>& cases = simulated_.fitted().cases;
  const bool has_tip = std::any_of(cases.begin(), cases.end(), [](const LoadCase& c) { return c.tip.has_value(); });
  if (!outcome_.posterior || !outcome_.posterior->ok || !has_tip || !may_go_on()) return;
  begin(FitStage::next_poke, "where a poke would tell most");
  NextPoke next =
      next_poke(simulated_.fitted(), mesh(), model.map, *outcome_.posterior, outcome_.report.p, {}, plan_.equilibrium);
  add_warnings(next.warnings);
  if (!next.candidates.empty() && next.candidates.front().ok) outcome_.next_poke = next.candidates.front();
}

}  // namespace aspic
