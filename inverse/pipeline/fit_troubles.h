// Messages for problems of a fit, with the row of the data.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "data/data_set.h"
#include "estimate/fit.h"
#include "model/misfit.h"
#include "pipeline/fit_plan.h"

namespace aspic {

// Explains a stiffness beyond any material, caused by readings that no stiffness can fit, such as forces of another
// body. Empty if the stiffness is plausible.
std::string describe_runaway(const DataSet& data, const MaterialParameters& material);

// Explains a fit without a material, with the row of the first unsolved case.
std::string describe_failure(const DataSet& data, const FitReport& report, const std::string& why);

// Names the row with the largest residual r of the fitted cases if it is far above the noise; otherwise empty.
std::string describe_worst_row(const DataSet& data, const std::vector<std::string>& left_out, const Misfit& misfit,
                               std::span<const double> r);

}  // namespace aspic
