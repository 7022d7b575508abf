// A fit as one self-contained HTML file: the viewer's page with measurements and results.
#pragma once
#include <string>
#include <vector>

#include "capture/fit_run.h"

namespace aspic::viewer {

// `history`: the iterations of the fit in ascending order.
std::string fit_page(const DataSet& data, const FitOutcome& outcome, const std::vector<FitIteration>& history);

}  // namespace aspic::viewer
