// The fit with `--model auto`: compares laws and fits the material with the preferred one whose verdict is good.
#pragma once
#include "pipeline/fit_run.h"

namespace aspic {

// `plan`: completed, with model = kAutoLaw. Without a law whose verdict is good, returns the material of the preferred
// one; its verdict is bad.
FitOutcome fit_with_chosen_law(const DataSet& data, const FitPlan& plan, const FitMemory& memory,
                               const FitCallbacks& callbacks);

}  // namespace aspic
