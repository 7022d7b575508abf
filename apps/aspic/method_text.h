// A method of minimization as one word: NAME[:OPTION...], such as newton:clamped or lbfgs:diagonal.
#pragma once
#include <string>
#include <vector>

#include "optimize/solver.h"

namespace aspic::cli {

// The method with the options of `base` that are not about the method. Throws InvalidInput for an unknown name.
SolverOptions method_named(const std::string& text, const SolverOptions& base);

bool contains(const std::vector<std::string>& names, const std::string& name);

}  // namespace aspic::cli
