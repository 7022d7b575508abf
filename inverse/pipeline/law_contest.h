// Fits every law of a comparison to the same measurements.
#pragma once
#include "pipeline/fit_run.h"

namespace aspic {

// `plan`: completed, with model = kAutoLaw. Fields per tet and at handles are replaced by one value, or one per region.
// A stop, or a job that is left to another process, returns what has been fitted so far, without a choice.
LawChoice choose_law(const DataSet& data, const FitPlan& plan, FitJobs& jobs, const FitCallbacks& callbacks);

// The plan of the comparison: fields per tet and at handles become one value, or one per region. `what`, if not null:
// what replaces them; unchanged without fields.
FitPlan simplified(FitPlan plan, const TetMesh& mesh, std::string* what = nullptr);

// Plan of the fit with the chosen law.
FitPlan plan_with_law(const FitPlan& plan, const LawChoice& choice);

}  // namespace aspic
