#include "pipeline/fit_stages.h"

namespace aspic {

void quantify_uncertainty(FitState& state) {
  if (!state.plan.uncertainty || state.is_stopped()) return;
  state.begin(FitStage::uncertainty,
              has_many_values(state.plan) ? "standard deviation of every tet" : "standard deviations");
  FitModel& model = *state.model;
  const FitReport& report = state.outcome.report;
  std::optional<Posterior>& posterior = state.outcome.posterior;
  WithUncertainLayers about_fit(model.recorded());
  posterior = aspic::posterior(about_fit, *model.prior, report.weight, {model.map, state.mesh(), report.p});
  // If the initial guess already explains the data, weight rules raise the weight, and the prior would look like data.
  const bool is_informed = !posterior->ok || posterior->informed >= 1;
  if (!is_informed && state.plan.fit.weight <= 0 && report.weight > 1) {
    posterior = aspic::posterior(about_fit, *model.prior, 1, {model.map, state.mesh(), report.p});
    std::erase(posterior->warnings, posterior->weight_warning);
    state.warn(
        "the data hardly determine how the stiffness varies: the standard deviations are those of the "
        "prior (--unknown young=uniform fits one value)");
  }
  // For a few values the prior is weak by intention.
  if (!has_many_values(state.plan)) std::erase(posterior->warnings, posterior->weight_warning);
  state.outcome.errors =
      estimated_errors(about_fit, report.p, state.simulated, state.data.experiment, state.outcome.known_posterior());
  for (const std::string& text : posterior->warnings) state.warn(text);
}

}  // namespace aspic
