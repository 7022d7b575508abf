#include "pipeline/fit_run.h"

#include "pipeline/chosen_law_fit.h"
#include "pipeline/material_fit.h"
#include "pipeline/relaxation.h"

namespace aspic {

FitOutcome fit_material(const DataSet& data, const FitPlan& plan, const FitMemory& memory,
                        const FitCallbacks& callbacks) {
  if (plan.model == kAutoLaw) return fit_with_chosen_law(data, completed(plan, data.experiment), memory, callbacks);
  MaterialFit fit(data, plan, memory, callbacks);
  FitOutcome outcome = fit.run();
  const bool has_branches = !data.histories.empty() && outcome.plan.branches >= 0;
  if (has_branches && outcome.has_material() && !outcome.interrupted) add_relaxation(data, callbacks, fit, outcome);
  if (outcome.posterior) outcome.posterior->gaussian.reset();  // refers to the prior of `fit`
  return outcome;
}

}  // namespace aspic
