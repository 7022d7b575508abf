#include "optimize/kept_hessian.h"

#include <cmath>

#include "base/check.h"

namespace aspic {

void KeptHessian::keep(const Objective& E, const BlockSparse& H, std::span<const double> x) {
  H_ = &H;
  x_.assign(x.begin(), x.end());
  number_ = E.hessians_made();
}

void KeptHessian::note_solve(double gradient_norm, double relative_residual) {
  norm_before_ = gradient_norm;
  predicted_norm_ = relative_residual * gradient_norm;
}

bool KeptHessian::serves(double gradient_norm, const InnerAccuracy& accuracy) const {
  if (!H_ || accuracy.enough <= 0) return false;
  return std::abs(gradient_norm - predicted_norm_) <= accuracy.enough * norm_before_;
}

void KeptHessian::restore(Objective& E) {
  if (E.hessians_made() == number_) return;
  const BlockSparse& again = E.hessian(x_, {Definiteness::exact});
  ASPIC_CHECK(&again == H_);
  number_ = E.hessians_made();
}

}  // namespace aspic
