// Predictions of the groups that a fit leaves out (FitPlan::left_out).
#pragma once
#include "data/data_set.h"
#include "estimate/cross_validation.h"
#include "pipeline/fit_run.h"

namespace aspic {

Measured left_out_cases(const DataSet& data, const FitPlan& plan);

// Compares the predictions of all left-out cases with the measurements. Not ok without any.
HeldOut compare_held_out(const DataSet& data, const FitOutcome& outcome);

}  // namespace aspic
