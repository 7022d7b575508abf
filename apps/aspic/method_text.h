// Minimization methods as text: NAME[:OPTION...], such as newton:clamped or lbfgs:diagonal.
#pragma once
#include <string>
#include <vector>

#include "optimize/solver.h"

namespace aspic::cli {

// Returns `base` with the method replaced. Throws InvalidInput for an unknown name.
SolverOptions method_named(const std::string& text, const SolverOptions& base);

bool contains(const std::vector<std::string>& names, const std::string& name);

}  // namespace aspic::cli
