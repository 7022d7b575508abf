#include "pipeline/fit_run.h"

#include "pipeline/chosen_law_fit.h"
#include "pipeline/fit_stages.h"
#include "pipeline/relaxation.h"

namespace aspic {
namespace {

void run_stages(FitState& state) {
  if (fits_fibres(state.plan) && !find_fibres(state)) return;
  const bool is_in_two_stages = is_field(state.plan) || state.has_model_errors() || state.has_corrections();
  if (is_in_two_stages) {
    if (!fit_single_values(state, "uniform")) return;
    // Without a field, fit_fields() repeats this fit.
    const bool is_repeated = !is_field(state.plan) && !state.has_corrections();
    if (correct_model_errors(state) && !is_repeated && !fit_single_values(state, "uniform_corrected")) return;
    if (!is_field(state.plan)) state.outcome.uniform.reset();
  }
  fit_fields(state);
}

}  // namespace

FitOutcome fit_material(const DataSet& data, const FitPlan& plan, const FitMemory& memory,
                        const FitCallbacks& callbacks) {
  if (plan.model == kAutoLaw) return fit_with_chosen_law(data, completed(plan, data.experiment), memory, callbacks);
  FitState state(data, plan, memory, callbacks);
  run_stages(state);
  const bool has_branches = !data.histories.empty() && state.plan.branches >= 0;
  if (has_branches && state.outcome.has_material() && !state.outcome.interrupted) add_relaxation(state);
  if (state.outcome.posterior) state.outcome.posterior->gaussian.reset();  // refers to the prior of the model
  return std::move(state.outcome);
}

}  // namespace aspic
