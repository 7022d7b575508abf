#include "fit/marginals.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

using Fields = std::vector<std::vector<double>>;  // a value per parameter and tet

Fields zero_fields(const ParameterMap& map) {
  Fields fields;
  for (size_t u = 0; u < map.fitted_parameters().size(); ++u)
    fields.emplace_back(map.basis(static_cast<int>(u)).tet_count(), 0.0);
  return fields;
}

// fields += scale (F v)^2, tet by tet.
void add_squares(const ParameterMap& map, std::span<const double> v, double scale, Fields& fields) {
  for (size_t u = 0; u < fields.size(); ++u) {
    std::vector<double> z(fields[u].size());
    map.multiply_fitted(static_cast<int>(u), v, z);
    for (size_t t = 0; t < z.size(); ++t) fields[u][t] += scale * z[t] * z[t];
  }
}

// diag F (C - W W') F': the variance outside the directions W.
Fields unseen_exactly(PosteriorGaussian& gaussian, const ParameterMap& map) {
  Fields unseen = zero_fields(map);
  std::vector<double> a(gaussian.size()), z(gaussian.size());
  for (size_t u = 0; u < unseen.size(); ++u) {
    std::vector<double> unit(unseen[u].size(), 0.0);
    for (size_t t = 0; t < unit.size(); ++t) {
      std::ranges::fill(a, 0.0);
      unit[t] = 1;
      map.add_fitted_transposed(static_cast<int>(u), unit, a);
      unit[t] = 0;
      gaussian.before().covariance(a, z);
      const std::vector<double> seen = product_transposed(gaussian.spectrum().W, a);
      unseen[u][t] = std::max(dot(a, z) - dot(seen, seen), 0.0);
    }
  }
  return unseen;
}

// Mean square of prior samples without their part in W.
Fields unseen_by_samples(PosteriorGaussian& gaussian, const ParameterMap& map, const MarginalOptions& options) {
  Fields unseen = zero_fields(map);
  std::mt19937_64 random(options.seed);
  std::vector<double> x(gaussian.size());
  for (int s = 0; s < options.samples; ++s) {
    gaussian.before().sample(random, x);
    add_product(gaussian.spectrum().W, product_transposed(gaussian.spectrum().dual, x), -1, x);
    add_squares(map, x, 1.0 / options.samples, unseen);
  }
  return unseen;
}

}  // namespace

Marginals marginals(PosteriorGaussian& gaussian, const ParameterMap& map, const MarginalOptions& options) {
  const Spectrum& s = gaussian.spectrum();
  Marginals m{.before = zero_fields(map), .after = zero_fields(map)};
  for (int k = 0; k < s.W.count(); ++k) {
    add_squares(map, s.W[k], 1, m.before);
    add_squares(map, s.W[k], 1 / (1 + s.d[k]), m.after);
  }
  if (s.complete) return m;
  size_t values = 0;
  for (const auto& field : m.before) values += field.size();
  const bool exact = values <= static_cast<size_t>(options.exact);
  const Fields unseen = exact ? unseen_exactly(gaussian, map) : unseen_by_samples(gaussian, map, options);
  for (size_t u = 0; u < unseen.size(); ++u)
    for (size_t t = 0; t < unseen[u].size(); ++t) {
      m.before[u][t] += unseen[u][t];
      m.after[u][t] += unseen[u][t];
      // The variance of N squares of a normal number is 2 / N of its square; that of the root is half as much.
      if (!exact && m.after[u][t] > 0)
        m.relative_error = std::max(m.relative_error, std::sqrt(0.5 / options.samples) * unseen[u][t] / m.after[u][t]);
    }
  return m;
}

}  // namespace aspic
