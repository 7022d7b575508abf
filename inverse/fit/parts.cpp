#include "fit/parts.h"

#include <algorithm>
#include <cmath>

#include "mesh/tet_shape.h"

namespace aspic {
namespace {

// Independent tets with standard deviation 1 at mean volume: the metric for changes of single tets.
class Independent : public Gaussian {
 public:
  explicit Independent(std::vector<double> precision) : precision_(std::move(precision)) {}
  int size() const override { return static_cast<int>(precision_.size()); }
  void precision(std::span<const double> v, std::span<double> y) override {
    for (size_t i = 0; i < v.size(); ++i) y[i] = precision_[i] * v[i];
  }
  void covariance(std::span<const double> v, std::span<double> z) override {
    for (size_t i = 0; i < v.size(); ++i) z[i] = v[i] / precision_[i];
  }

 private:
  std::vector<double> precision_;
};

Independent one_by_one(const ParameterMap& map, int unknown, const std::vector<double>& volumes, double total) {
  const auto [first, tets] = map.range(unknown);
  std::vector<double> precision(static_cast<size_t>(map.size()), 1.0);
  for (int t = 0; t < tets; ++t) precision[first + t] = volumes[t] * tets / total;
  return Independent(std::move(precision));
}

// The change by one more linearization is a lower bound of the uncertainty.
void widen(PartsEstimate& estimate, std::span<const double> before) {
  for (size_t t = 0; t < before.size(); ++t)
    estimate.sigma[t] = std::hypot(estimate.sigma[t], estimate.mean[t] - before[t]);
}

}  // namespace

Parts find_parts(LeastSquares& model, const FittedField& field, int unknown, int count, const PartsOptions& options) {
  const auto& [map, mesh, p] = field;
  const auto [first, tets] = map.range(unknown);
  std::vector<double> volumes;
  double total = 0;
  for (int t = 0; t < tets; ++t) total += volumes.emplace_back(volume(mesh, t));
  Independent prior = one_by_one(map, unknown, volumes, total);
  Parts parts{.p = std::vector<double>(p.begin(), p.end())};
  const std::span<double> z = std::span(parts.p).subspan(first, tets);
  std::vector<double> r(model.residual_count()), g(p.size());
  std::vector<double> levels = gathered_levels(z, volumes, count);
  if (static_cast<int>(levels.size()) < count) return parts;
  for (int pass = 0; pass < options.passes; ++pass) {
    if (!model.evaluate(parts.p, r) || !model.linearize()) return parts;
    const double noise_factor = std::max(1.0, std::sqrt(dot(r, r) / static_cast<double>(r.size())));
    const bool is_last = pass + 1 == options.passes;
    const Spectrum s = spectrum(model, prior, {.max_rank = is_last ? options.rank : options.rank / 4});
    if (!s.ok) return parts;
    model.multiply_transposed(r, g);
    parts.estimate = sample_parts({mesh, s, g, first, z, noise_factor}, levels, options);
    levels = parts.estimate.levels;
    if (is_last) widen(parts.estimate, z);
    std::copy(parts.estimate.mean.begin(), parts.estimate.mean.end(), z.begin());
  }
  parts.ok = model.evaluate(parts.p, r);
  parts.squares = dot(r, r);
  return parts;
}

bool are_as_good(const Parts& parts, double field_squares, int residuals) {
  return parts.ok && parts.squares <= std::max(field_squares, 1.0 * residuals) + 2 * std::sqrt(2.0 * residuals);
}

}  // namespace aspic
