// Choice of a law and relaxation times as sentences for reports.
#pragma once
#include <string>
#include <vector>

#include "capture/fit_run.h"

namespace aspic {

std::vector<std::string> result_notes(const FitOutcome& outcome);

}  // namespace aspic
