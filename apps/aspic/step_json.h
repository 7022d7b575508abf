#pragma once
#include <string>

#include "results/explanation.h"

namespace aspic::cli {

// Returns one line of JSON; numbers that are not finite are null.
std::string step_json(const StepReport& report, const Explanation& why, const Simulation& simulation);

}  // namespace aspic::cli
