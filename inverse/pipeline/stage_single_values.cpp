#include <cmath>

#include "pipeline/fit_stages.h"
#include "pipeline/fit_troubles.h"

namespace aspic {
namespace {

std::string suffix(double factor) {
  if (factor == 1) return "";
  return factor > 1 ? "_stiffer" + std::to_string(std::lround(factor)) : "_softer";
}

bool has_single_values(FitState& state, FitModel& model, const FitReport& report) {
  adopt_values(model.map, report.p, state.plan);
  state.material = model.map.parameters(report.p);
  state.outcome.failure = describe_runaway(state.data, state.material.front());
  if (!state.outcome.failure.empty()) return false;
  if (report.status != Status::interrupted) {
    state.estimate_corrections(model, report.p);
    if (model.journal) model.journal->catch_up();
    state.simulated.start_from(model.misfit.state());
    if (!is_field(state.plan) && state.p_of_errors.empty()) state.p_of_errors = report.p;
    return true;
  }
  describe(state, model, report.p);
  return false;
}

}  // namespace

bool fit_single_values(FitState& state, const std::string& name) {
  state.begin(FitStage::uniform, "for the whole body");
  const FitOptions options = for_single_values(state.plan.fit);
  for (const double factor : kGuessFactors) {
    FitModel model =
        state.model_of(state.plan, stiffer(single_values(state.plan.parameters), factor), name + suffix(factor));
    const FitReport report = fit_model(state, FitStage::uniform, model, options);
    state.outcome.uniform = state.outcome.report = report;
    if (!report.has_material()) {
      state.outcome.failure = describe_failure(state.data, report, model.misfit.failure());
      continue;
    }
    if (!has_single_values(state, model, report)) return false;
    break;
  }
  if (!state.outcome.failure.empty()) return false;
  // One value explains a field worse than wrong corrections do.
  if (!is_field(state.plan)) state.apply_corrections();
  return true;
}

}  // namespace aspic
