// Functions with known minima, as objectives of the minimisers. Vectors are padded to whole 3x3 blocks: a function of
// x and y ignores z, whose gradient is z itself.
#pragma once
#include "optimize/objective.h"

namespace aspic {

// f(x, y) = (1 - x)^2 + 100 (y - x^2)^2: minimum 0 at (1, 1) at the end of a curved valley.
class Rosenbrock : public Objective {
 public:
  Rosenbrock();
  double value(std::span<const double> x) override;
  void gradient(std::span<const double> x, std::span<double> g) override;
  const BlockSparse& hessian(std::span<const double> x, const Projection& projection) override;

 private:
  BlockPattern pattern_;
  BlockSparse H_;
};

}  // namespace aspic
