// Energy densities psi = W(I1bar) + K/2 (J - 1)^2 of the isochoric invariant I1bar = J^(-2/3) I1; +inf for J <= 0. W is
// independent of volume, so the volume term alone determines the bulk modulus K.
#pragma once
#include "material/barrier.h"
#include "material/from_invariants.h"
#include "material/lame.h"

namespace aspic {

template <class T>
T bulk_modulus(const LameOver<T>& l) {
  return l.lambda + T(2.0 / 3.0) * l.mu;
}

// Returns J^(-2/3).
template <class T>
T isochoric_scale(const T& J) {
  const T root = cbrt(J);
  return T(1.0) / (root * root);
}

template <class T>
T isochoric_energy(const T& J, const T& W, const T& bulk) {
  const T dJ = J - T(1.0);
  return infinite_unless_positive(J, W + T(0.5) * bulk * dJ * dJ);
}

// Applies the chain rule: dI1bar/dI1 = J^(-2/3), dI1bar/dJ = -2/3 I1bar / J.
template <class T>
LawDerivatives<T> isochoric_derivatives(const T& I1, const T& J, const T& dW, const T& ddW, const T& bulk) {
  const T s = isochoric_scale(J), r = T(1.0) / J;
  const T slope = T(-2.0 / 3.0) * s * r;  // d2 I1bar / dI1 dJ
  const T dI1bar_dJ = slope * I1;
  return {.dI = dW * s,
          .dJ = dW * dI1bar_dJ + bulk * (J - T(1.0)),
          .dII = ddW * s * s,
          .dIJ = ddW * s * dI1bar_dJ + dW * slope,
          .dJJ = ddW * dI1bar_dJ * dI1bar_dJ - T(5.0 / 3.0) * dW * dI1bar_dJ * r + bulk};
}

}  // namespace aspic
