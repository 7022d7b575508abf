#include "estimate/uncertainty.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/formatted.h"
#include "estimate/evidence.h"
#include "mesh/tet_shape.h"
#include "model/handle_gaps.h"
#include "model/quantity.h"

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
Fields undetermined_exactly(PosteriorGaussian& gaussian, const ParameterMap& map) {
  Fields undetermined = zero_fields(map);
  std::vector<double> a(gaussian.size()), z(gaussian.size());
  for (size_t u = 0; u < undetermined.size(); ++u) {
    std::vector<double> unit(undetermined[u].size(), 0.0);
    for (size_t t = 0; t < unit.size(); ++t) {
      std::fill(a.begin(), a.end(), 0.0);
      unit[t] = 1;
      map.add_fitted_transposed(static_cast<int>(u), unit, a);
      unit[t] = 0;
      gaussian.prior().covariance(a, z);
      const std::vector<double> determined = product_transposed(gaussian.spectrum().W, a);
      undetermined[u][t] = std::max(dot(a, z) - dot(determined, determined), 0.0);
    }
  }
  return undetermined;
}

// Mean square of prior samples without their part in W.
Fields undetermined_by_samples(PosteriorGaussian& gaussian, const ParameterMap& map, const MarginalOptions& options) {
  Fields undetermined = zero_fields(map);
  std::mt19937_64 random(options.seed);
  std::vector<double> x(gaussian.size());
  for (int s = 0; s < options.samples; ++s) {
    gaussian.prior().sample(random, x);
    add_product(gaussian.spectrum().W, product_transposed(gaussian.spectrum().dual, x), -1, x);
    add_squares(map, x, 1.0 / options.samples, undetermined);
  }
  return undetermined;
}

// |J e|^2 for a common shift of log E: scaled stiffness of the whole body.
double information_of_scale(LeastSquares& data, const ParameterMap& map, int young) {
  std::vector<double> shift(map.size(), 0.0), dr(data.residual_count());
  const auto [first, count] = map.range(young);
  std::fill_n(shift.begin() + first, count, 1.0);  // the weights of a tet sum to 1
  data.multiply(shift, dr);
  return dot(dr, dr);
}

int stiffness_of(const ParameterMap& map) {
  for (size_t u = 0; u < map.fitted_parameters().size(); ++u)
    if (is_stiffness(map.fitted_parameters()[u].quantity)) return static_cast<int>(u);
  return -1;
}

void warn_of_scale(LeastSquares& data, const ParameterMap& map, Posterior& result) {
  constexpr double kNothing = 1e-2;  // information 1 / sigma^2 of log E: a factor of e^10
  const int young = stiffness_of(map);
  if (young < 0) return;
  result.scale_is_unknown = information_of_scale(data, map, young) < kNothing;
  if (result.scale_is_unknown)
    result.warnings.push_back(
        "without any force, torque, weight or pressure only ratios of stiffness are determined: all of young could be "
        "larger or smaller by a common factor, and its level is the initial guess (measure one force)");
}

double informed(const Spectrum& s) {
  double sum = 0;
  for (const double d : s.d) sum += d / (1 + d);
  return sum;
}

// With correct standard deviations |r|^2 is between residuals - informed (complete fit) and residuals, within the
// scatter of chi^2.
void judge_noise(double misfit, int residuals, Posterior& result, Spectrum& s) {
  const double free = std::max(residuals - informed(s), 1.0);
  const double lower = free - 3 * std::sqrt(2 * free), upper = residuals + 3 * std::sqrt(2.0 * residuals);
  result.noise_factor = std::sqrt(misfit / free);
  if (misfit > upper) {
    result.applied_factor = result.noise_factor;
    for (double& d : s.d) d /= result.noise_factor * result.noise_factor;
    result.misfit_warning = formatted(
        "|r|^2 is %.3g per reading, clearly more than 1: the standard deviations of the readings are too small, the "
        "weight of the regularizer is too large, or the model cannot represent the body; all intervals are %.3g times "
        "wider",
        misfit / residuals, result.noise_factor);
  } else if (misfit < lower) {
    result.misfit_warning = formatted(
        "|r|^2 is %.3g per reading, clearly less than 1: the standard deviations, with those of a correction for the "
        "mesh, are too large, or noise was fitted (a larger weight helps); the intervals are not narrowed",
        misfit / residuals);
  }
  if (!result.misfit_warning.empty()) result.warnings.push_back(result.misfit_warning);
}

void judge_weight(Regularizer& prior, double weight, std::span<const double> p, const Spectrum& s, Posterior& result) {
  if (!(weight > 0) || s.d.empty()) return;
  const auto [best, gain] = supported_weight(prior, weight, p, s);
  result.suggested_weight = weight * best;
  constexpr double kClear = 8;  // exceeded by chance once in 200 cases (chi^2, one degree of freedom)
  if (gain < kClear) return;
  result.weight_warning = formatted(
      best < 1 ? "the weight of the regularizer, %.3g, is %.2g times larger than what the data support (%.3g): details "
                 "are lost and the standard deviations too small"
               : "the weight of the regularizer, %.3g, is %.2g times smaller than what the data support (%.3g): noise "
                 "may have been fitted",
      weight, std::max(best, 1 / best), result.suggested_weight);
  result.warnings.push_back(result.weight_warning);
}

void warn_of_rank(Posterior& result) {
  constexpr double kMuch = 3;  // d of a direction whose standard deviation is sqrt(1 + d) = 2 times too large
  const Spectrum& s = result.gaussian->spectrum();
  if (s.missed > kMuch)
    result.warnings.push_back(formatted(
        "only the %d best determined directions were computed; the others may be determined %.2g times better than "
        "shown, none worse",
        s.W.count(), std::sqrt(1 + s.missed)));
}

void set_fields(const Marginals& m, Posterior& result) {
  result.sigma_error = m.relative_error;
  for (size_t u = 0; u < m.posterior.size(); ++u) {
    std::vector<double>& sigma = result.sigma.emplace_back();
    std::vector<double>& reduction = result.reduction.emplace_back();
    for (size_t t = 0; t < m.posterior[u].size(); ++t) {
      sigma.push_back(std::sqrt(m.posterior[u][t]));
      reduction.push_back(m.prior[u][t] > 0 ? 1 - m.posterior[u][t] / m.prior[u][t] : 0);
    }
  }
}

double variance_over_body(const TetMesh& mesh, std::span<const double> z) {
  double all = 0, sum = 0, squares = 0;
  for (size_t t = 0; t < z.size(); ++t) {
    const double v = volume(mesh, static_cast<int>(t));
    all += v, sum += v * z[t], squares += v * z[t] * z[t];
  }
  return std::max(squares / all - (sum / all) * (sum / all), 0.0);
}

// Adds the variance that a field may have between its handles, if it varies there as much as over the body.
void add_handle_gaps(const FittedField& fitted, Marginals& m) {
  for (int u = 0; u < static_cast<int>(m.posterior.size()); ++u) {
    const std::vector<double> gaps = handle_gaps(fitted.mesh, fitted.map.basis(u));
    if (gaps.empty()) continue;
    const double field = variance_over_body(fitted.mesh, fitted.map.fitted_values(u, fitted.p));
    for (size_t t = 0; t < gaps.size(); ++t) m.prior[u][t] += field * gaps[t], m.posterior[u][t] += field * gaps[t];
  }
}

double log_evidence(double misfit, double weight, double roughness, const Spectrum& s) {
  double determinant = 0;
  for (const double d : s.d) determinant += std::log1p(d);
  return -misfit / 2 - weight * roughness - determinant / 2;
}

}  // namespace

Marginals marginals(PosteriorGaussian& gaussian, const ParameterMap& map, const MarginalOptions& options) {
  const Spectrum& s = gaussian.spectrum();
  Marginals m{.prior = zero_fields(map), .posterior = zero_fields(map)};
  for (int k = 0; k < s.W.count(); ++k) {
    add_squares(map, s.W[k], 1, m.prior);
    add_squares(map, s.W[k], 1 / (1 + s.d[k]), m.posterior);
  }
  if (s.complete) return m;
  size_t values = 0;
  for (const auto& field : m.prior) values += field.size();
  const bool exact = values <= static_cast<size_t>(options.exact);
  const Fields undetermined =
      exact ? undetermined_exactly(gaussian, map) : undetermined_by_samples(gaussian, map, options);
  for (size_t u = 0; u < undetermined.size(); ++u)
    for (size_t t = 0; t < undetermined[u].size(); ++t) {
      m.prior[u][t] += undetermined[u][t];
      m.posterior[u][t] += undetermined[u][t];
      // The variance of N squares of a normal number is 2 / N of its square; that of the root is half as much.
      if (!exact && m.posterior[u][t] > 0)
        m.relative_error =
            std::max(m.relative_error, std::sqrt(0.5 / options.samples) * undetermined[u][t] / m.posterior[u][t]);
    }
  return m;
}

Posterior posterior(LeastSquares& data, Regularizer& prior, double weight, const FittedField& fitted,
                    const PosteriorOptions& options) {
  const auto& [map, mesh, p] = fitted;
  ASPIC_CHECK(map.size() == static_cast<int>(p.size()) && data.parameter_count() == map.size());
  Posterior result;
  std::vector<double> r(data.residual_count());
  if (!data.evaluate(p, r) || !data.linearize()) {
    result.warnings.push_back("the uncertainty is unknown: no stable equilibrium was found at the fit");
    return result;
  }
  warn_of_scale(data, map, result);
  PriorGaussian gaussian_prior(prior, weight, p);
  Spectrum s = spectrum(data, gaussian_prior, options.spectrum);
  if (!s.ok) {
    result.warnings.push_back("the uncertainty is unknown: a derivative at the fit could not be computed");
    return result;
  }
  const double roughness = prior.value(p), squares = dot(r, r);
  result.log_evidence = log_evidence(squares, weight, roughness, s);
  judge_weight(prior, weight, p, s, result);
  judge_noise(squares, data.reading_count(), result, s);
  result.informed = informed(s);
  result.gaussian = std::make_shared<PosteriorGaussian>(std::move(gaussian_prior), std::move(s));
  warn_of_rank(result);
  Marginals m = marginals(*result.gaussian, map, options.marginals);
  add_handle_gaps(fitted, m);
  set_fields(m, result);
  result.ok = true;
  return result;
}

Interval interval(const Posterior& posterior, const ParameterMap& map, std::span<const double> p, const TetQuantity& of,
                  double sigmas) {
  const auto [parameter, tet] = of;
  const double z = map.fitted_values(parameter, p)[tet], s = sigmas * posterior.sigma[parameter][tet];
  return {map.value(parameter, z - s), map.value(parameter, z + s)};
}

}  // namespace aspic
