// Reuses the Hessian of an earlier iteration if one more step with it is expected to converge: Shamanskii's method
// [Kelley 1995, section 5.4.3].
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "optimize/search_direction.h"

namespace aspic {

class KeptHessian {
 public:
  void drop() { H_ = nullptr; }
  // Keeps the Hessian that E computed at x. E owns it and overwrites it with the next one.
  void keep(const Objective& E, const BlockSparse& H, std::span<const double> x);
  // Records the relative residual of a solve of H d = -g.
  void note_solve(double gradient_norm, double relative_residual);

  // Returns whether a step with the kept Hessian is expected to converge from this gradient norm. The step leaves about
  // | |g| - |g + H d| | / |g_previous| of g [Eisenstat and Walker 1996, choice 1].
  bool serves(double gradient_norm, const InnerAccuracy& accuracy) const;
  // Recomputes the Hessian if an observer has overwritten it.
  void restore(Objective& E);

 private:
  const BlockSparse* H_ = nullptr;
  std::vector<double> x_;  // positions of the kept Hessian
  uint64_t number_ = 0;    // Objective::hessians_made() of the kept Hessian
  double norm_before_ = 0, predicted_norm_ = 0;
};

}  // namespace aspic
