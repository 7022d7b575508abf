// Predictions of groups of cases that a fit has not used: left out by the plan, or held out by the cross-validation.
#include "pipeline/fit_stages.h"

namespace aspic {
namespace {

// Called with the prediction on the mesh and the one that is corrected for its discretization error.
using UsePrediction = std::function<void(CaseOutcome&, const CasePrediction& on_mesh, const CasePrediction&)>;

// Predicts the cases of a group with a material.
void predict_group(FitState& state, const std::string& group, std::span<const double> p, const UsePrediction& use) {
  const Corrected part = subset(state.simulated.all(), [&](const LoadCase& c) { return c.group == group; });
  Misfit misfit(part, state.model->map, state.plan.equilibrium);
  if (const auto x = state.simulated.equilibria([&](const LoadCase& c) { return c.group == group; }); !x.empty())
    misfit.set_state(x);
  std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
  if (!misfit.evaluate(p, r)) return state.warn("'" + group + "' could not be predicted: " + misfit.failure());
  int own = 0;
  for (size_t c = 0; c < state.data.experiment.cases.size(); ++c) {
    if (state.data.experiment.cases[c].group != group) continue;
    const CasePrediction& on_mesh = misfit.prediction(own++);
    use(state.outcome.cases[c], on_mesh, as_read_on_finer_mesh(state.simulated, c, on_mesh));
  }
}

CrossValidation cross_validated(FitState& state, FitModel& model, const FitReport& report, FitOptions options,
                                const std::string& name) {
  options.stop = StopToken([&state] { return state.is_stopped(); });
  const auto observe = [&](int group, int groups, const std::string& label) {
    state.begin(FitStage::cross_validation,
                "'" + label + "' is held out (" + std::to_string(group + 1) + " of " + std::to_string(groups) + ")");
  };
  const HeldOutJobs jobs{state.jobs, name, state.plan, [&state] { return state.is_stopped(); }};
  return cross_validate(state.simulated.fitted(), model.map, *model.prior, report,
                        {options, state.plan.equilibrium, observe, &state.simulated.all(),
                         jobs.store(state.simulated.fitted(), report), state.simulated.equilibria()});
}

// Baseline for a field.
std::optional<CrossValidation> cross_validated_one_value(FitState& state) {
  const FitOptions options = for_single_values(state.plan.fit);
  FitModel one(state.data.experiment, state.simulated, state.plan, single_values(state.plan.parameters), {{}, "", ""});
  const FitReport report = fit(one.data(), *one.prior, one.map.guess(), options);
  if (!is_success(report.status)) return std::nullopt;
  return cross_validated(state, one, report, options, "one_value_held_out");
}

struct HeldOutGroups {
  CrossValidation all;                          // predictions of the fit
  std::optional<CrossValidation> of_one_value;  // baseline for a field
};

// The outcome is interrupted if a result is missing.
HeldOutGroups hold_out_groups(FitState& state) {
  HeldOutGroups held_out{cross_validated(state, *state.model, state.outcome.report, state.plan.fit, "held_out"), {}};
  if (is_field(state.plan) && !state.is_stopped() && !state.jobs.has_computed())
    held_out.of_one_value = cross_validated_one_value(state);
  state.outcome.interrupted |= state.jobs.is_waiting();
  return held_out;
}

}  // namespace

void predict_left_out(FitState& state) {
  for (const std::string& group : state.plan.left_out)
    predict_group(state, group, state.p,
                  [](CaseOutcome& outcome, const CasePrediction& on_mesh, const CasePrediction& prediction) {
                    outcome.ok = outcome.has_held_out = true;
                    outcome.markers_on_mesh = on_mesh.markers;
                    outcome.wrench_on_mesh = on_mesh.wrench;
                    outcome.markers = outcome.held_out_markers = prediction.markers;
                    outcome.wrench = outcome.held_out_wrench = prediction.wrench;
                  });
}

void compute_held_out_jobs(FitState& state) { hold_out_groups(state); }

void cross_validate_groups(FitState& state) {
  if (!state.plan.cross_validation || state.is_stopped()) return;
  HeldOutGroups held_out = hold_out_groups(state);
  if (state.outcome.interrupted) return;  // the last group may be incomplete
  for (const std::string& text : held_out.all.warnings) state.warn(text);
  for (const HeldOut& group : held_out.all.groups)
    if (group.ok)
      predict_group(state, group.group, group.p,
                    [](CaseOutcome& outcome, const CasePrediction&, const CasePrediction& prediction) {
                      outcome.has_held_out = true;
                      outcome.held_out_markers = prediction.markers;
                      outcome.held_out_wrench = prediction.wrench;
                    });
  state.outcome.held_out = std::move(held_out.all);
  state.outcome.held_out_of_one_value = std::move(held_out.of_one_value);
}

}  // namespace aspic
