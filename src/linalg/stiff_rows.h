// Stiff rank-one parts of a matrix H: sum over rows of weight g g'. H contains them. Solvers whose preconditioner they
// would spoil separate them, see LiftedSolver.
#pragma once
#include <array>
#include <vector>

#include "math/small.h"

namespace aspic {

struct StiffRow {
  std::array<int, 10> vertex{};  // block rows of H, all different
  std::array<Vec3d, 10> g{};
  double weight = 0;      // > 0
  double compliance = 0;  // estimate of g' A^-1 g, where A is H without its stiff rows; > 0
};
using StiffRows = std::vector<StiffRow>;

}  // namespace aspic
