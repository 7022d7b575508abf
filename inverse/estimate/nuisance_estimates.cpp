#include "estimate/nuisance_estimates.h"

#include <algorithm>
#include <cmath>

#include "math/vectors.h"

namespace aspic {

// For given p, q is normal with the variance sigma^2 - sigma^4 |L dr/dq|^2. Its mean is linear in p,
//   dq/dp = -sigma^2 (L dr/dq)' L J,
// so the uncertainty of p adds (dq/dp) C (dq/dp)'.
std::vector<NuisanceEstimate> nuisance_estimates(WithUncertainLayers& data, std::span<const double> p,
                                                 Gaussian* posterior) {
  std::vector<double> r(static_cast<size_t>(data.residual_count()));
  if (!data.evaluate(p, r) || !data.linearize()) return {};
  std::vector<NuisanceEstimate> estimates;
  for (const double value : data.estimates(r)) estimates.push_back({.value = value});
  std::vector<double> slope(p.size()), spread(p.size());
  for (int k = 0; posterior && k < data.bounded_count(); ++k) {
    const double variance = data.sigma(k) * data.sigma(k);
    const std::vector<double> n = data.whitened_direction(k);
    data.multiply_transposed(n, slope);
    posterior->covariance(slope, spread);
    const double left = 1 - variance * (dot(n, n) - dot(slope, spread));
    if (std::isfinite(left)) estimates[k].sigma = data.sigma(k) * std::sqrt(std::clamp(left, 0.0, 1.0));
  }
  return estimates;
}

}  // namespace aspic
