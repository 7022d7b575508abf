#include "fit/bounded_least_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kFirstBoxDamping = 1e-3, kLeastBoxDamping = 1e-12, kLargestBoxDamping = 1e16;
constexpr double kNegligible = 1e-24;    // relative to |r|^2 of the guess: exact data are fitted to round-off
constexpr double kUndetermined = 1e-13;  // a pivot below this part of its diagonal entry

using Vector = std::vector<double>;

// Small symmetric matrix, row-major.
class Square {
 public:
  explicit Square(int n) : n_(n), a_(static_cast<size_t>(n) * n, 0.0) {}
  double& operator()(int i, int j) { return a_[static_cast<size_t>(i) * n_ + j]; }
  double operator()(int i, int j) const { return a_[static_cast<size_t>(i) * n_ + j]; }
  int size() const { return n_; }

  // Factorizes L L' in the lower triangle; false: not positive definite beyond round-off.
  bool factorize() {
    for (int j = 0; j < n_; ++j) {
      const double diagonal = (*this)(j, j);
      for (int k = 0; k < j; ++k) (*this)(j, j) -= (*this)(j, k) * (*this)(j, k);
      if (!((*this)(j, j) > kUndetermined * diagonal)) return false;
      (*this)(j, j) = std::sqrt((*this)(j, j));
      for (int i = j + 1; i < n_; ++i) {
        for (int k = 0; k < j; ++k) (*this)(i, j) -= (*this)(i, k) * (*this)(j, k);
        (*this)(i, j) /= (*this)(j, j);
      }
    }
    return true;
  }
  void solve(Vector& x) const {
    for (int i = 0; i < n_; ++i) {
      for (int k = 0; k < i; ++k) x[i] -= (*this)(i, k) * x[k];
      x[i] /= (*this)(i, i);
    }
    for (int i = n_; i-- > 0;) {
      for (int k = i + 1; k < n_; ++k) x[i] -= (*this)(k, i) * x[k];
      x[i] /= (*this)(i, i);
    }
  }

 private:
  int n_;
  Vector a_;
};

// argmin d'A d / 2 + g'd over lower <= d <= upper, where 0 is feasible, by the primal active-set method. False: A is
// not positive definite.
class BoundedQuadratic {
 public:
  BoundedQuadratic(const Square& A, const Vector& g, const Vector& lower, const Vector& upper)
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
    for (size_t i = 0; i < g_.size(); ++i)
      if (side_[i] == 0) inner.push_back(static_cast<int>(i));
    Square B(static_cast<int>(inner.size()));
    Vector b(inner.size());
    for (size_t a = 0; a < inner.size(); ++a) {
      b[a] = -g_[inner[a]];
      for (size_t j = 0; j < g_.size(); ++j)
        if (side_[j] != 0) b[a] -= entry(inner[a], j) * d[j];
      for (size_t c = 0; c <= a; ++c) B(static_cast<int>(a), static_cast<int>(c)) = entry(inner[a], inner[c]);
    }
    if (!B.factorize()) return false;
    B.solve(b);
    for (size_t a = 0; a < inner.size(); ++a) d[inner[a]] = b[a];
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
      for (size_t j = 0; j < d.size(); ++j) slope += entry(i, j) * d[j], size += std::abs(entry(i, j) * d[j]);
      const double wrong = side_[i] * slope / (size > 0 ? size : 1);
      if (side_[i] != 0 && wrong > 1e-12 && wrong > most) most = wrong, worst = i;
    }
    if (worst == d.size()) return false;
    side_[worst] = 0;
    return true;
  }
  double entry(size_t i, size_t j) const {
    return i >= j ? A_(static_cast<int>(i), static_cast<int>(j)) : A_(static_cast<int>(j), static_cast<int>(i));
  }

  const Square& A_;
  const Vector &g_, &lower_, &upper_;
  std::vector<int> side_;  // -1, 1: held at the lower, upper bound
};

class Run {
 public:
  Run(LeastSquares& problem, std::span<const Bounds> bounds, const BoundedFitOptions& options)
      : problem_(problem), bounds_(bounds), options_(options), n_(problem.unknowns()), m_(problem.residual_count()) {
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
  double clipped(int i, double x) const { return std::clamp(x, bounds_[i].lower, bounds_[i].upper); }

  bool evaluate(const Vector& p, Vector& r, BoundedFit& fit) {
    ++fit.evaluations;
    if (!problem_.evaluate(p, r)) return false;
    return std::all_of(r.begin(), r.end(), [](double x) { return std::isfinite(x); });
  }

  // Computes J column by column, g = J' r, and which parameters have an effect.
  bool linearize(const Vector& r) {
    if (!problem_.linearize()) return false;
    J_.assign(static_cast<size_t>(n_), Vector(static_cast<size_t>(m_)));
    g_.assign(static_cast<size_t>(n_), 0.0);
    free_.clear();
    Vector unit(static_cast<size_t>(n_), 0.0);
    for (int i = 0; i < n_; ++i) {
      unit[i] = 1;
      problem_.multiply(unit, J_[i]);
      unit[i] = 0;
      for (int k = 0; k < m_; ++k) g_[i] += J_[i][k] * r[k];
      if (squared_norm(J_[i]) > 0) free_.push_back(i);
    }
    return true;
  }

  Square normal_matrix(const std::vector<int>& which, double damping) const {
    Square A(static_cast<int>(which.size()));
    for (int a = 0; a < A.size(); ++a)
      for (int b = 0; b <= a; ++b) {
        for (int k = 0; k < m_; ++k) A(a, b) += J_[which[a]][k] * J_[which[b]][k];
        if (a == b) A(a, a) *= 1 + damping;
      }
    return A;
  }

  // |r + J d|^2
  double predicted(const Vector& p, const Vector& q, const Vector& r) const {
    Vector linear = r;
    for (int i = 0; i < n_; ++i)
      for (int k = 0; k < m_; ++k) linear[k] += J_[i][k] * (q[i] - p[i]);
    return squared_norm(linear);
  }

  // Updates p and r; false: no damping gives a decrease.
  bool step(Vector& p, Vector& r, double& damping, BoundedFit& fit) {
    const double before = squared_norm(r);
    for (; damping < kLargestBoxDamping; damping *= 4) {
      const Square A = normal_matrix(free_, damping);
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
      damping = good ? std::fmax(kLeastBoxDamping, damping / 9) : damping;
      return true;
    }
    return false;
  }

  void finish(const Vector& p, Vector& r, BoundedFit& fit) {
    fit.p = p;
    fit.objective = squared_norm(r) / 2;
    fit.at_bound.assign(static_cast<size_t>(n_), false);
    fit.deviation.assign(static_cast<size_t>(n_), std::numeric_limits<double>::infinity());
    if (!evaluate(p, r, fit) || !linearize(r)) return;
    std::vector<int> inner;
    for (int i = 0; i < n_; ++i) {
      fit.at_bound[i] = p[i] <= bounds_[i].lower || p[i] >= bounds_[i].upper;
      if (fit.at_bound[i]) fit.deviation[i] = 0;
      if (!fit.at_bound[i] && squared_norm(J_[i]) > 0) inner.push_back(i);
    }
    const int freedom = m_ - static_cast<int>(inner.size());
    Square A = normal_matrix(inner, 0);
    if (freedom <= 0 || !A.factorize()) return;
    for (size_t a = 0; a < inner.size(); ++a) {
      Vector column(inner.size(), 0.0);
      column[a] = 1;
      A.solve(column);
      fit.deviation[inner[a]] = std::sqrt(2 * fit.objective / freedom * column[a]);
    }
  }

  LeastSquares& problem_;
  std::span<const Bounds> bounds_;
  const BoundedFitOptions& options_;
  int n_, m_;
  std::vector<Vector> J_;
  Vector g_;
  std::vector<int> free_;
};

}  // namespace

BoundedFit minimize_within(LeastSquares& problem, std::span<const double> guess, std::span<const Bounds> bounds,
                           const BoundedFitOptions& options) {
  return Run(problem, bounds, options).from(guess);
}

}  // namespace aspic
