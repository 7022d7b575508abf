// Levenberg-Marquardt for few parameters: computes the Jacobian by columns (or rows, if residuals are fewer), solves
// (J'J + weight R'' + damping D) d = -g directly, and adapts the damping to the ratio of actual and predicted decrease
// [Madsen et al. 2004, alg. 3.16]. D is the diagonal, which makes it independent of units.
#include <algorithm>
#include <cmath>

#include "fit/fit_run.h"
#include "linalg/scalar_cholesky.h"

namespace aspic {
namespace {

constexpr double kNear = 0.01;  // distance from the minimum in standard deviations; cheap for few parameters

constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-14, kLargestDamping = 1e12;
constexpr double kUnseen = 1e-14;  // relative to the largest diagonal entry; smaller ones count as 0

// Symmetric n x n matrix.
class Curvature {
 public:
  explicit Curvature(int n) : n_(n), a_(static_cast<size_t>(n) * n, 0.0) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) places_.push_back({i, j});
    cholesky_.analyze(n, places_);
  }
  double& at(int i, int j) { return a_[static_cast<size_t>(i) * n_ + j]; }
  void clear() { std::fill(a_.begin(), a_.end(), 0.0); }
  // d = -(A + damping D)^-1 g; false: not positive definite.
  bool step(std::span<const double> g, double damping, std::span<double> d) {
    std::vector<double> entries;
    double largest = 0;
    for (int i = 0; i < n_; ++i) largest = std::max(largest, at(i, i));
    for (const auto& [i, j] : places_)
      entries.push_back(at(i, j) + (i == j ? damping * std::max(at(i, i), kUnseen * largest) : 0));
    if (!cholesky_.factorize(entries)) return false;
    for (int i = 0; i < n_; ++i) d[i] = -g[i];
    cholesky_.solve(d, d);
    return true;
  }
  double along(std::span<const double> d) {
    double sum = 0;
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j) sum += d[i] * at(i, j) * d[j];
    return sum;
  }

 private:
  int n_;
  std::vector<double> a_;
  std::vector<MatrixPlace> places_;
  ScalarCholesky cholesky_;
};

// A = J'J + weight R''
void make_curvature(FitRun& run, const FitPoint& at, Curvature& A) {
  const int n = run.unknowns(), m = run.residuals();
  std::vector<double> J(static_cast<size_t>(n) * m), unit, line;  // column by column
  const bool by_columns = n <= m;
  unit.assign(static_cast<size_t>(by_columns ? n : m), 0.0);
  line.resize(static_cast<size_t>(by_columns ? m : n));
  for (size_t k = 0; k < unit.size(); ++k) {
    unit[k] = 1;
    by_columns ? run.multiply(unit, line) : run.multiply_transposed(unit, line);
    unit[k] = 0;
    for (size_t l = 0; l < line.size(); ++l) J[by_columns ? k * m + l : l * m + k] = line[l];
  }
  A.clear();
  std::vector<double> e(static_cast<size_t>(n), 0.0), column(static_cast<size_t>(n));
  for (int j = 0; j < n; ++j) {
    e[j] = 1;
    std::fill(column.begin(), column.end(), 0.0);
    run.add_prior_product(at, e, run.weight, column);
    e[j] = 0;
    const std::span Jj(J.data() + static_cast<size_t>(j) * m, static_cast<size_t>(m));
    for (int i = 0; i < n; ++i)
      A.at(i, j) = column[i] + dot({J.data() + static_cast<size_t>(i) * m, static_cast<size_t>(m)}, Jj);
  }
}

struct MarquardtDamping {
  double value = kFirstDamping, growth = 2;

  void reward(double ratio) {
    const double s = 2 * ratio - 1;
    value = std::max(kLeastDamping, value * std::max(1.0 / 3, 1 - s * s * s));
    growth = 2;
  }
  void punish() {
    value *= growth;
    growth *= 2;
  }
};

// g' A^-1 g for the undamped system if it is positive definite.
double squared_decrement(Curvature& A, std::span<const double> g, std::vector<double>& d) {
  for (double damping = 0; damping < 1; damping = std::max(kLeastDamping, 100 * damping))
    if (A.step(g, damping, d)) return std::max(0.0, -dot(g, d));
  return std::nan("");
}

}  // namespace

Status levenberg_marquardt(FitRun& run, FitPoint& at, FitGoal& goal) {
  const size_t n = at.p.size();
  Curvature A(run.unknowns());
  std::vector<double> g(n), d(n), p(n);
  MarquardtDamping damping;
  for (;;) {
    if (run.is_stopped()) return run.stop_status();
    if (!run.linearize(at)) return Status::undefined;
    run.gradient(at, g);
    make_curvature(run, at, A);
    if (max_abs(g) == 0) return Status::converged;
    const double decrement = std::sqrt(squared_decrement(A, g, d));
    if (!std::isfinite(decrement)) return Status::no_descent;
    if (goal.is_reached(decrement) && decrement <= kNear) return Status::converged;
    if (is_lost_in_noise(decrement, at.objective(run.weight))) return Status::round_off;
    if (run.iterations_left() <= 0) return Status::iteration_limit;

    FitIteration done{.decrement = decrement};
    const double before = at.objective(run.weight);
    FitPoint trial;
    bool found = false;
    for (; !found && damping.value < kLargestDamping && !run.is_stopped(); ++done.trials) {
      if (!A.step(g, damping.value, d) || max_abs(d) > run.options.max_step) {
        damping.punish();
        continue;
      }
      for (size_t i = 0; i < n; ++i) p[i] = at.p[i] + d[i];
      const double predicted = -dot(g, d) - A.along(d) / 2;
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
    if (!found) return run.is_stopped() ? run.stop_status() : Status::stuck;
    if (run.options.stop.requested()) return Status::interrupted;
  }
}

}  // namespace aspic
