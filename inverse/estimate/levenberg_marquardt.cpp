// Levenberg-Marquardt for few parameters: computes the Jacobian by columns (or rows, if residuals are fewer), solves
// (J'J + weight R'' + damping D) d = -g directly, and adapts the damping to the ratio of actual and predicted decrease
// [Madsen et al. 2004, alg. 3.16]. D is the diagonal, which makes it independent of units.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "estimate/fit_run.h"

namespace aspic {
namespace {

// Decrement, in posterior standard deviations, if no step is found. Jacobians with differences, such as those of scans
// under gravity, have errors of about 1e-6 |r|.
constexpr double kNegligibleDecrement = 1e-3;
constexpr double kNearMinimum = 0.01;   // distance from the minimum in standard deviations; cheap for few parameters
constexpr double kFirstDamping = 1e-3;  // for acceptable guesses [Madsen et al. 2004, section 3.2]
// A smaller damping vanishes in the round-off of sums of some 50 terms; a larger one makes steps shorter than 1e-12.
constexpr double kMinDamping = 1e-14, kLargestDamping = 1e12;

using Eigen::MatrixXd;
using Eigen::VectorXd;

Eigen::Map<const VectorXd> as_vector(std::span<const double> v) { return {v.data(), std::ssize(v)}; }

// d = -(A + damping D)^-1 g; false: not positive definite.
bool find_step(const MatrixXd& A, std::span<const double> g, double damping, std::span<double> d) {
  MatrixXd damped = A;
  damped.diagonal() += damping * A.diagonal().cwiseMax(kMinDamping * A.diagonal().maxCoeff());
  const Eigen::LLT<MatrixXd> factor(damped);
  if (factor.info() != Eigen::Success) return false;
  Eigen::Map<VectorXd>(d.data(), std::ssize(d)) = -factor.solve(as_vector(g));
  return true;
}

// J'J + weight R''
MatrixXd curvature(FitRun& run, const FitPoint& at) {
  const int n = run.parameter_count(), m = run.residuals();
  const bool by_columns = n <= m;
  MatrixXd J(m, n), A(n, n);
  std::vector<double> unit(by_columns ? n : m, 0.0), line(by_columns ? m : n);
  for (int k = 0; k < std::ssize(unit); ++k) {
    unit[k] = 1;
    by_columns ? run.multiply(unit, line) : run.multiply_transposed(unit, line);
    unit[k] = 0;
    if (by_columns)
      J.col(k) = as_vector(line);
    else
      J.row(k) = as_vector(line);
  }
  A.noalias() = J.transpose() * J;
  std::vector<double> e(n, 0.0), column(n);
  for (int j = 0; j < n; ++j) {
    e[j] = 1;
    std::fill(column.begin(), column.end(), 0.0);
    run.add_prior_product(at, e, run.weight, column);
    e[j] = 0;
    A.col(j) += as_vector(column);
  }
  return A;
}

struct MarquardtDamping {
  double value = kFirstDamping, growth = 2;

  void reward(double ratio) {
    const double s = 2 * ratio - 1;
    value = std::max(kMinDamping, value * std::max(1.0 / 3, 1 - s * s * s));
    growth = 2;
  }
  void punish() {
    value *= growth;
    growth *= 2;
  }
};

// g' A^-1 g for the undamped system if it is positive definite.
double squared_decrement(const MatrixXd& A, std::span<const double> g, std::vector<double>& d) {
  double damping = 0;
  while (damping < 1) {
    if (find_step(A, g, damping, d)) return std::max(0.0, -dot(g, d));
    damping = std::max(kMinDamping, 100 * damping);
  }
  return std::nan("");
}

}  // namespace

Status levenberg_marquardt(FitRun& run, FitPoint& at, FitGoal& goal) {
  const size_t n = at.p.size();
  std::vector<double> g(n), d(n), p(n);
  MarquardtDamping damping;
  for (;;) {
    if (run.is_stopped()) return run.stop_status();
    if (!run.linearize(at)) return Status::undefined;
    run.gradient(at, g);
    const MatrixXd A = curvature(run, at);
    if (max_abs(g) == 0) return Status::converged;
    const double decrement = std::sqrt(squared_decrement(A, g, d));
    if (!std::isfinite(decrement)) return Status::no_descent;
    if (goal.is_reached(decrement) && decrement <= kNearMinimum) return Status::converged;
    if (is_lost_in_noise(decrement, at.objective(run.weight))) return Status::round_off;
    if (run.iterations_left() <= 0) return Status::iteration_limit;

    FitIteration done{.decrement = decrement};
    const double before = at.objective(run.weight);
    FitPoint trial;
    bool found = false;
    for (; !found && damping.value < kLargestDamping && !run.is_stopped(); ++done.trials) {
      if (!find_step(A, g, damping.value, d) || max_abs(d) > run.options.max_step) {
        damping.punish();
        continue;
      }
      for (size_t i = 0; i < n; ++i) p[i] = at.p[i] + d[i];
      const double predicted = -dot(g, d) - as_vector(d).dot(A * as_vector(d)) / 2;
      const bool defined = run.evaluate(p, trial);
      const double ratio = defined ? (before - trial.objective(run.weight)) / predicted : -1;
      found = ratio > 0;
      found ? damping.reward(std::min(ratio, 1.0)) : damping.punish();
    }
    if (found) {
      done.step = max_abs(d);
      std::swap(at, trial);
    }
    run.note(done, at);
    if (!found && run.is_stopped()) return run.stop_status();
    if (!found) return decrement <= kNegligibleDecrement ? Status::round_off : Status::stuck;
    if (run.options.stop.requested()) return Status::interrupted;
  }
}

}  // namespace aspic
