#pragma once
#include <string>
#include <vector>

namespace aspic::cli::lecture {

// The formulas of a demonstration as MathML; empty where it has none, and in programs without the viewer, whose page's
// build makes them (web/src/formulas.json).
std::vector<std::string> formulas_of(const std::string& key);

}  // namespace aspic::cli::lecture
