// Integrals of a Maxwell branch over one step, for strains that are linear in time. With x = duration / relaxation time
// and p = 1 - exp(-x), the stress of a branch with modulus G is
//   s(y) = exp(-y) s_0 + (1 - exp(-y)) / x w,  y = t / tau in [0, x],  w = 2 G dE,
// so that it ends at s_1 = exp(-x) s_0 + phi w with phi = p / x, and dissipates
//   1/(2G) int_0^x |s|^2 dy = 1/(2G) (A |s_0 + r w|^2 + R |w|^2),
//   A = p (2 - p) / 2,  r = p / (x (2 - p)),  R = (x - p - p^2/2 - p^3 / (2 (2 - p))) / x^2 >= 0.
#pragma once
#include <cmath>

namespace aspic {

struct MaxwellFactors {
  double decay = 1;      // exp(-x)
  double phi = 1;        // (1 - exp(-x)) / x
  double loss_sum = 0;   // A
  double mixture = 0.5;  // r
  double loss_rest = 0;  // R
};

// x >= 0. At x = 0 the branch is elastic.
inline MaxwellFactors maxwell_factors(double x) {
  if (!(x > 0)) return {};
  const double p = -std::expm1(-x);
  MaxwellFactors f{.decay = std::exp(-x), .phi = p / x, .loss_sum = p * (2 - p) / 2, .mixture = p / (x * (2 - p))};
  double rest = x - p - p * p / 2 - p * p * p / (2 * (2 - p));
  if (p < 0.5) {  // with x = p + p^2/2 + p^3/3 + ..., all terms are positive
    rest = 0;
    double power = p * p * p;
    for (int k = 3; k <= 60; ++k, power *= p) rest += power * (1.0 / k - std::ldexp(1.0, 1 - k));
  }
  f.loss_rest = rest / x / x;
  return f;
}

}  // namespace aspic
