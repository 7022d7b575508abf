#pragma once
#include <string>
#include <vector>

namespace aspic::cli {

// Returns formulas as MathML: those of a demonstration of the lecture by its name (web/src/formulas.json), or one of a
// material, integrator or check by its TeX. Empty if there are none, or if the program was built without the viewer,
// whose page generates them.
std::vector<std::string> formulas_of(const std::string& key);

}  // namespace aspic::cli
