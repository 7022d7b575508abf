#include "capture/fit_run.h"

#include "capture/material_fit.h"

namespace aspic {

FitOutcome fit_material(const DataSet& data, const FitPlan& plan, const FitMemory& memory, const FitWitness& witness) {
  FitOutcome outcome = MaterialFit(data, plan, memory, witness).run();
  if (outcome.posterior) outcome.posterior->belief.reset();  // refers to the prior, which is gone
  return outcome;
}

}  // namespace aspic
