#include "capture/fit_run.h"

#include "capture/material_fit.h"

namespace aspic {

FitOutcome fit_material(const DataSet& data, const FitPlan& plan, const FitMemory& memory,
                        const FitCallbacks& callbacks) {
  FitOutcome outcome = MaterialFit(data, plan, memory, callbacks).run();
  if (outcome.posterior) outcome.posterior->gaussian.reset();  // refers to the prior, which no longer exists
  return outcome;
}

}  // namespace aspic
