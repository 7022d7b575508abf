#include "estimate/predictive_probability.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "math/vectors.h"

namespace aspic {
namespace {

using Columns2 = std::vector<std::vector<double>>;

// Columns of J at p; empty if it does not exist. Writes r.
Columns2 jacobian(LeastSquares& data, std::span<const double> p, std::vector<double>& r) {
  r.resize(static_cast<size_t>(data.residual_count()));
  if (!data.evaluate(p, r) || !data.linearize()) return {};
  Columns2 columns;
  std::vector<double> unit(p.size(), 0.0);
  for (size_t k = 0; k < p.size(); ++k) {
    unit[k] = 1;
    data.multiply(unit, columns.emplace_back(r.size()));
    unit[k] = 0;
    if (!std::isfinite(max_abs(columns.back()))) return {};
  }
  return columns;
}

std::vector<double> gram(const Columns2& J) {
  std::vector<double> product;
  for (const auto& a : J)
    for (const auto& b : J) product.push_back(dot(a, b));
  return product;
}

}  // namespace

double PredictiveResiduals::log_probability(double noise_factor) const {
  if (!is_valid) return -std::numeric_limits<double>::infinity();
  const auto n = static_cast<Eigen::Index>(Jr.size());
  const auto matrix = [n](const std::vector<double>& m) { return Eigen::Map<const Eigen::MatrixXd>(m.data(), n, n); };
  const double variance = noise_factor * noise_factor;
  const Eigen::MatrixXd before = matrix(fitted) / variance + matrix(prior), after = before + matrix(JJ) / variance;
  const Eigen::LDLT<Eigen::MatrixXd> factor_before(before), factor_after(after);
  const auto b = Eigen::Map<const Eigen::VectorXd>(Jr.data(), n) / variance;
  const double explained = b.dot(factor_after.solve(b));
  const double determinant = factor_after.vectorD().array().log().sum() - factor_before.vectorD().array().log().sum();
  const double value = -(squares / variance - explained + determinant) / 2;
  return std::isfinite(value) ? value : -std::numeric_limits<double>::infinity();
}

PredictiveResiduals predictive_residuals(LeastSquares& fitted, LeastSquares& held_out, Regularizer& prior,
                                         std::span<const double> p) {
  PredictiveResiduals result;
  std::vector<double> r, unit(p.size(), 0.0);
  const Columns2 of_fitted = jacobian(fitted, p, r), own = jacobian(held_out, p, r);
  if (of_fitted.empty() || own.empty()) return result;
  result.squares = dot(r, r);
  for (const auto& column : own) result.Jr.push_back(dot(column, r));
  result.JJ = gram(own);
  result.fitted = gram(of_fitted);
  result.prior.assign(p.size() * p.size(), 0.0);
  for (size_t k = 0; k < p.size(); ++k) {
    unit[k] = 1;
    prior.add_hessian_product(p, unit, 1, std::span(result.prior).subspan(k * p.size(), p.size()));
    unit[k] = 0;
  }
  result.is_valid = true;
  return result;
}

}  // namespace aspic
