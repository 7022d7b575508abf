// Barrier b(g) = -r (g/r - 1)^2 ln(g/r) of a gap g < r [m]; 0 for larger gaps. Twice continuously differentiable at the
// reach r, infinite at g = 0 [Li 2020].
#pragma once
#include <cmath>
#include <limits>

namespace aspic {

struct BarrierValue {
  double value, first, second;  // b [m], b' [1], b'' [1/m]
};

inline BarrierValue barrier(double gap, double reach) {
  if (gap >= reach) return {0, 0, 0};
  if (!(gap > 0)) return {std::numeric_limits<double>::infinity(), 0, 0};
  const double s = gap / reach, t = s - 1, log = std::log(s);
  return {-reach * t * t * log, -(2 * t * log + t * t / s), -(2 * log + 4 * t / s - t * t / (s * s)) / reach};
}

}  // namespace aspic
