// What goes wrong in a fit of measurements, with the row of the data where it does.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "capture/data_set.h"
#include "fit/fit.h"
#include "fit/misfit.h"

namespace aspic {

// Of a stiffness that no body has: of readings that no stiffness makes smaller or larger, such as forces of a body that
// they do not belong to. Else empty.
std::string words_of_runaway(const DataSet& data, const MaterialParameters& material);

// Of a fit that ended without a material, with the row of the first case that could not be solved.
std::string words_of_failure(const DataSet& data, const FitReport& report, const std::string& why);

// Which row is explained worst by residuals r of the cases that are not left out, when that is far more than noise;
// else empty.
std::string words_of_worst_row(const DataSet& data, const std::vector<std::string>& left_out, const Misfit& misfit,
                               std::span<const double> r);

bool is_left_out(const std::vector<std::string>& left_out, const LoadCase& c);

}  // namespace aspic
