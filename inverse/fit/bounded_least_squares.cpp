#include "fit/bounded_least_squares.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "base/check.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kFirstBoxDamping = 1e-3, kMinBoxDamping = 1e-12, kLargestBoxDamping = 1e16;
constexpr double kNegligible = 1e-24;    // relative to |r|^2 of the guess: exact data are fitted to round-off
constexpr double kUndetermined = 1e-13;  // a pivot below this part of its diagonal entry

using Vector = std::vector<double>;

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Cholesky factorization of a matrix that is positive definite beyond round-off, otherwise nothing.
std::optional<Eigen::LLT<MatrixXd>> factorized(const MatrixXd& A) {
  Eigen::LLT<MatrixXd> factor(A);
  const MatrixXd& L = factor.matrixLLT();
  if (factor.info() != Eigen::Success) return std::nullopt;
  if (!(L.diagonal().array().square() > kUndetermined * A.diagonal().array()).all()) return std::nullopt;
  return factor;
}

// argmin d'A d / 2 + g'd over lower <= d <= upper, where 0 is feasible, by the primal active-set method. False: A is
// not positive definite.
class BoundedQuadratic {
 public:
  BoundedQuadratic(const MatrixXd& A, const Vector& g, const Vector& lower, const Vector& upper)
      : A_(A), g_(g), lower_(lower), upper_(upper), side_(g.size(), 0) {}

  bool minimize(Vector& d) {
    d.assign(g_.size(), 0.0);
    for (size_t changes = 0; changes < 20 * g_.size() + 20; ++changes) {
      Vector to = d;
      if (!solve_free(to)) return false;
      if (!go(d, to) && !release(d)) break;
    }
    return true;
  }

 private:
  bool solve_free(Vector& d) const {
    std::vector<int> inner;
    VectorXd held = VectorXd::Zero(std::ssize(d));
    for (size_t i = 0; i < g_.size(); ++i) {
      if (side_[i] == 0) inner.push_back(static_cast<int>(i));
      if (side_[i] != 0) held[i] = d[i];
    }
    const auto factor = factorized(A_(inner, inner));
    if (!factor) return false;
    const VectorXd right = -(Eigen::Map<const VectorXd>(g_.data(), std::ssize(g_)) + A_ * held);
    const VectorXd solution = factor->solve(right(inner));
    for (size_t a = 0; a < inner.size(); ++a) d[inner[a]] = solution[a];
    return true;
  }
  // Moves d toward `to` up to the first bound, which becomes active; true: there was one.
  bool go(Vector& d, const Vector& to) {
    double part = 1;
    size_t first = d.size();
    for (size_t i = 0; i < d.size(); ++i) {
      const double bound = to[i] < d[i] ? lower_[i] : upper_[i], way = to[i] - d[i];
      const bool crosses = to[i] < lower_[i] || to[i] > upper_[i];
      if (side_[i] == 0 && crosses && (bound - d[i]) / way < part) part = (bound - d[i]) / way, first = i;
    }
    for (size_t i = 0; i < d.size(); ++i) d[i] += part * (to[i] - d[i]);
    if (first == d.size()) return false;
    side_[first] = to[first] < d[first] ? -1 : 1;
    d[first] = side_[first] < 0 ? lower_[first] : upper_[first];
    return true;
  }
  // Releases the active bound with the largest multiplier of the wrong sign; true: there was one.
  bool release(const Vector& d) {
    double most = 0;
    size_t worst = d.size();
    for (size_t i = 0; i < d.size(); ++i) {
      double slope = g_[i], size = std::abs(g_[i]);
      for (size_t j = 0; j < d.size(); ++j) slope += A_(i, j) * d[j], size += std::abs(A_(i, j) * d[j]);
      const double wrong = side_[i] * slope / (size > 0 ? size : 1);
      if (side_[i] != 0 && wrong > 1e-12 && wrong > most) most = wrong, worst = i;
    }
    if (worst == d.size()) return false;
    side_[worst] = 0;
    return true;
  }

  const MatrixXd& A_;
  const Vector &g_, &lower_, &upper_;
  std::vector<int> side_;  // -1, 1: held at the lower, upper bound
};

class Run {
 public:
  Run(LeastSquares& problem, std::span<const Bounds> bounds, const BoundedFitOptions& options)
      : problem_(problem),
        bounds_(bounds),
        options_(options),
        n_(problem.parameter_count()),
        m_(problem.residual_count()) {
    ASPIC_CHECK(static_cast<int>(bounds.size()) == n_);
  }

  BoundedFit from(std::span<const double> guess) {
    BoundedFit fit;
    Vector p(guess.begin(), guess.end());
    for (int i = 0; i < n_; ++i) p[i] = clipped(i, p[i]);
    Vector r(static_cast<size_t>(m_));
    if (!evaluate(p, r, fit)) return fit;
    const double negligible = kNegligible * squared_norm(r);
    double damping = kFirstBoxDamping;
    while (fit.iterations < options_.max_iterations && !fit.is_converged) {
      if (squared_norm(r) <= negligible) fit.is_converged = true;
      if (fit.is_converged || !linearize(r)) break;
      ++fit.iterations;
      if (!step(p, r, damping, fit)) break;
    }
    finish(p, r, fit);
    return fit;
  }

 private:
  std::span<double> column(int i) { return {J_.col(i).data(), static_cast<size_t>(m_)}; }
  std::span<const double> column(int i) const { return {J_.col(i).data(), static_cast<size_t>(m_)}; }

  double clipped(int i, double x) const { return std::clamp(x, bounds_[i].lower, bounds_[i].upper); }

  bool evaluate(const Vector& p, Vector& r, BoundedFit& fit) {
    ++fit.evaluations;
    if (!problem_.evaluate(p, r)) return false;
    return std::all_of(r.begin(), r.end(), [](double x) { return std::isfinite(x); });
  }

  // Computes J column by column, g = J' r, and which parameters have an effect.
  bool linearize(const Vector& r) {
    if (!problem_.linearize()) return false;
    J_.resize(m_, n_);
    g_.resize(static_cast<size_t>(n_));
    free_.clear();
    Vector unit(static_cast<size_t>(n_), 0.0);
    for (int i = 0; i < n_; ++i) {
      unit[i] = 1;
      problem_.multiply(unit, column(i));
      unit[i] = 0;
      g_[i] = dot(column(i), r);
      if (squared_norm(column(i)) > 0) free_.push_back(i);
    }
    return true;
  }

  MatrixXd normal_matrix(const std::vector<int>& which, double damping) const {
    const MatrixXd J = J_(Eigen::all, which);
    MatrixXd A = J.transpose() * J;
    A.diagonal() *= 1 + damping;
    return A;
  }

  // |r + J d|^2
  double predicted(const Vector& p, const Vector& q, const Vector& r) const {
    Vector linear = r;
    for (int i = 0; i < n_; ++i) add_scaled(q[i] - p[i], column(i), linear);
    return squared_norm(linear);
  }

  // Updates p and r; false: no damping gives a decrease.
  bool step(Vector& p, Vector& r, double& damping, BoundedFit& fit) {
    const double before = squared_norm(r);
    for (; damping < kLargestBoxDamping; damping *= 4) {
      const MatrixXd A = normal_matrix(free_, damping);
      Vector g, lower, upper, d;
      for (const int i : free_) {
        g.push_back(g_[i]);
        lower.push_back(bounds_[i].lower - p[i]);
        upper.push_back(bounds_[i].upper - p[i]);
      }
      if (!BoundedQuadratic(A, g, lower, upper).minimize(d)) continue;
      Vector q = p;
      for (size_t a = 0; a < free_.size(); ++a) q[free_[a]] = clipped(free_[a], p[free_[a]] + d[a]);
      const double decrease = before - predicted(p, q, r);
      if (decrease <= options_.tolerance * before) {
        fit.is_converged = damping < 1;  // otherwise damping limited the step, which shows no convergence
        if (fit.is_converged) return true;
      }
      Vector trial(static_cast<size_t>(m_));
      if (!evaluate(q, trial, fit) || !(squared_norm(trial) < before)) continue;
      const bool good = before - squared_norm(trial) > 0.5 * decrease;
      p = q, r = trial;
      damping = good ? std::fmax(kMinBoxDamping, damping / 9) : damping;
      return true;
    }
    return false;
  }

  void finish(const Vector& p, Vector& r, BoundedFit& fit) {
    fit.p = p;
    fit.objective = squared_norm(r) / 2;
    fit.at_bound.assign(static_cast<size_t>(n_), false);
    fit.sigma.assign(static_cast<size_t>(n_), std::numeric_limits<double>::infinity());
    if (!evaluate(p, r, fit) || !linearize(r)) return;
    std::vector<int> inner;
    for (int i = 0; i < n_; ++i) {
      fit.at_bound[i] = p[i] <= bounds_[i].lower || p[i] >= bounds_[i].upper;
      if (fit.at_bound[i]) fit.sigma[i] = 0;
      if (!fit.at_bound[i] && squared_norm(column(i)) > 0) inner.push_back(i);
    }
    const int freedom = m_ - static_cast<int>(inner.size());
    const auto factor = factorized(normal_matrix(inner, 0));
    if (freedom <= 0 || !factor) return;
    const MatrixXd covariance = factor->solve(MatrixXd::Identity(std::ssize(inner), std::ssize(inner)));
    for (size_t a = 0; a < inner.size(); ++a)
      fit.sigma[inner[a]] = std::sqrt(2 * fit.objective / freedom * covariance(a, a));
  }

  LeastSquares& problem_;
  std::span<const Bounds> bounds_;
  const BoundedFitOptions& options_;
  int n_, m_;
  MatrixXd J_;
  Vector g_;
  std::vector<int> free_;
};

}  // namespace

BoundedFit minimize_within(LeastSquares& problem, std::span<const double> guess, std::span<const Bounds> bounds,
                           const BoundedFitOptions& options) {
  return Run(problem, bounds, options).from(guess);
}

}  // namespace aspic
