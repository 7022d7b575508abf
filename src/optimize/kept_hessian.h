// The Hessian of an iteration before, for the last digits, where its quadratic approximation is good enough that
// another step with it ends the minimization: Shamanskii's method [Kelley 1995, section 5.4.3].
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "optimize/search_direction.h"

namespace aspic {

class KeptHessian {
 public:
  void drop() { H_ = nullptr; }
  // Made by E at x. E holds it, and overwrites it whenever anyone asks for another one.
  void keep(const Objective& E, const BlockSparse& H, std::span<const double> x);
  // H d = -g has been solved with it, to this relative residual.
  void note_solve(double gradient_norm, double relative_residual);

  // Whether it serves once more, where the gradient has become this large. Its approximation was wrong by
  // | |g| - |g + H d| | / |g before| [Eisenstat and Walker 1996, choice 1]: about so much of g the next step leaves.
  bool serves(double gradient_norm, const InnerAccuracy& accuracy) const;
  // Has E hold it again after an observer asked for others: looking changes no bit.
  void restore(Objective& E);

 private:
  const BlockSparse* H_ = nullptr;
  std::vector<double> x_;  // where it was made
  uint64_t number_ = 0;    // of it among those of E
  double norm_before_ = 0, predicted_norm_ = 0;
};

}  // namespace aspic
