#pragma once
#include <string>
#include <vector>

namespace aspic::cli {

// Returns the formulas of a demonstration of the lecture or of a material as MathML. Empty if it has none, or if the
// program was built without the viewer, whose page generates them (web/src/formulas.json).
std::vector<std::string> formulas_of(const std::string& key);

}  // namespace aspic::cli
