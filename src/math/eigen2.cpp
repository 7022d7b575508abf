#include "math/eigen2.h"

#include <cmath>

namespace aspic {

Eigen2 symmetric_eigen(const Sym2& A) {
  const double mean = 0.5 * (A.xx + A.yy), half = 0.5 * (A.xx - A.yy), radius = std::sqrt(half * half + A.xy * A.xy);
  if (radius == 0) return {mean, mean, 1, 0};
  // The eigenvector (radius + half, xy) or, without cancellation for half < 0, (xy, radius - half).
  const double x = half < 0 ? A.xy : radius + half, y = half < 0 ? radius - half : A.xy,
               s = 1 / std::sqrt(x * x + y * y);
  return {mean + radius, mean - radius, s * x, s * y};
}

}  // namespace aspic
