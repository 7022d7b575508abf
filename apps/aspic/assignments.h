// Command-line arguments that are values of a scene.
#pragma once
#include <string>
#include <vector>

namespace aspic::cli {

// Inserts --set before each further KEY=VALUE: `--set A=1 B=2` becomes `--set A=1 --set B=2`. The name of an existing
// file is no assignment.
std::vector<std::string> spread_assignments(const std::vector<std::string>& arguments);

}  // namespace aspic::cli
