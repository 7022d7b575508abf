// Several assignments after one --set.
#pragma once
#include <string>
#include <vector>

namespace aspic::cli {

// The arguments with a --set before each KEY=VALUE that follows one: `--set A=1 B=2` is `--set A=1 --set B=2`. A name
// of an existing file is none.
std::vector<std::string> spread_assignments(const std::vector<std::string>& arguments);

}  // namespace aspic::cli
