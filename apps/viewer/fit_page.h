// A fit as one HTML file that needs nothing else: the viewer's page with everything that was measured and found inside.
#pragma once
#include <string>
#include <vector>

#include "capture/fit_run.h"

namespace aspic::viewer {

// `history`: the iterations of the fit itself, in their order.
std::string fit_page(const DataSet& data, const FitOutcome& outcome, const std::vector<FitIteration>& history);

}  // namespace aspic::viewer
