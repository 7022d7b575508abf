#pragma once
#include <string>
#include <vector>

namespace aspic::cli::lecture {

// Returns the formulas of a demonstration as MathML. Empty if it has none, or if the program was built without the
// viewer, whose page generates them (web/src/formulas.json).
std::vector<std::string> formulas_of(const std::string& key);

}  // namespace aspic::cli::lecture
