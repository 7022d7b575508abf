// Fits every law of a comparison to the same measurements.
#pragma once
#include "pipeline/fit_run.h"

namespace aspic {

// `plan`: completed, with model = kAutoLaw. Fields per tet and at handles are replaced by one value, or one per region.
// A stop, or a job that is left to another process, returns what has been fitted so far, without a choice.
LawChoice choose_law(const DataSet& data, const FitPlan& plan, FitJobs& jobs, const FitCallbacks& callbacks);

}  // namespace aspic
