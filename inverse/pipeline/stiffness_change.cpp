#include "pipeline/stiffness_change.h"

#include <algorithm>
#include <cmath>

#include "math/vectors.h"
#include "model/limits.h"
#include "model/quantity.h"

namespace aspic {
bool StiffnessChange::differs_from(const StiffnessChange& other) const {
  double squares = 0;
  for (size_t i = 0; i < g.size(); ++i) squares += (g[i] - other.g[i]) * (g[i] - other.g[i]);
  return squares > kNegligible * kNegligible * dot(g, g);
}

std::optional<StiffnessChange> stiffness_change(const Experiment& ends, const FittedField& fitted, Gaussian& posterior,
                                                const EquilibriumOptions& equilibrium) {
  const ParameterMap& map = fitted.map;
  Misfit misfit(ends, map, equilibrium);
  std::vector<double> r(static_cast<size_t>(misfit.residual_count())), effect(r.size());
  if (!misfit.evaluate(fitted.p, r) || !misfit.linearize()) return std::nullopt;
  const auto size = static_cast<size_t>(map.size());
  std::vector<double> common(size, 0.0), g(size, 0.0);
  for (size_t u = 0; u < map.fitted_parameters().size(); ++u) {
    if (!is_stiffness(map.fitted_parameters()[u].quantity)) continue;
    const auto [first, count] = map.range(static_cast<int>(u));
    std::fill_n(common.begin() + first, count, 1.0);
  }
  misfit.multiply(common, effect);
  misfit.multiply_transposed(effect, g);
  const double squares = dot(effect, effect);
  if (!(squares > 0)) return std::nullopt;
  for (double& x : g) x /= squares;
  StiffnessChange change{.g = std::move(g), .p = std::vector<double>(size, 0.0)};
  posterior.covariance(change.g, change.p);
  const double variance = dot(change.g, change.p);
  if (!(variance > 0) || !std::isfinite(variance)) return std::nullopt;
  for (double& x : change.p) x /= variance;
  change.sigma = std::sqrt(variance);
  return change;
}

void narrow(const StiffnessChange& change, const ParameterMap& map, double sigma, Posterior& posterior) {
  const double less = std::max(change.sigma * change.sigma - sigma * sigma, 0.0);
  for (size_t u = 0; u < posterior.sigma.size(); ++u) {
    std::vector<double> z(posterior.sigma[u].size());
    map.multiply_fitted(static_cast<int>(u), change.p, z);
    for (size_t t = 0; t < z.size(); ++t) {
      double& own = posterior.sigma[u][t];
      const double before = own * own, after = std::max(before - less * z[t] * z[t], 0.0);
      own = std::sqrt(after);
      if (before > 0) posterior.reduction[u][t] = 1 - (1 - posterior.reduction[u][t]) * after / before;
    }
  }
}

}  // namespace aspic
