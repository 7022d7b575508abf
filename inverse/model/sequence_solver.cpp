#include "model/sequence_solver.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "linalg/auto_solver.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr size_t kRemembered = 6;     // solutions save two to four digits (tests/bench/results/adjoint.md)
constexpr int kMaxCgIterations = 50;  // with a factor of another matrix; a new one costs a dozen or more (adjoint.md)

// y += s x
void add(double s, std::span<const double> x, std::span<double> y) {
  parallel_chunks(static_cast<int>(x.size()), [&](int first, int last) {
    for (int i = first; i < last; ++i) y[i] += s * x[i];
  });
}
void scale(double s, std::span<double> x) {
  for (double& xi : x) xi *= s;
}

// Kept factor of a solver, for any matrix.
class KeptFactor : public ApproximateInverse {
 public:
  explicit KeptFactor(LinearSolver& solver) : solver_(solver) {}
  std::string_view name() const override { return solver_.name(); }
  void analyze(const BlockPattern&) override {}
  bool factorize(const BlockSparse&) override { return true; }
  void apply(std::span<const double> r, std::span<double> z) override { as_cholesky(solver_)->substitute(r, z); }

 private:
  LinearSolver& solver_;
};

}  // namespace

SequenceSolver::SequenceSolver(const std::string& linear, double tolerance)
    : solver_(make_linear_solver(linear)),
      by_factor_(std::make_unique<KeptFactor>(*solver_), kMaxCgIterations),
      tolerance_(tolerance) {}

void SequenceSolver::begin() {
  last_.clear();
  digits_ = 0;
  solver_->begin();
}

SequenceReport SequenceSolver::solve(const BlockSparse& H, std::span<const double> b, std::span<double> x) {
  for (Vector* v : {&residual_, &rest_}) v->resize(b.size());
  if (analyzed_version_ != H.pattern->version) {
    solver_->analyze(*H.pattern);
    by_factor_.analyze(*H.pattern);
    digits_ = 0;
  }
  analyzed_version_ = H.pattern->version;

  project(H, b, x);
  H.multiply(x, rest_);
  for (size_t i = 0; i < b.size(); ++i) residual_[i] = b[i] - rest_[i];
  const double size = norm(b), left = norm(residual_);
  SequenceReport report;
  SolveReport& solve = report.solve;
  if (left <= tolerance_ * size) {
    solve.ok = true;
    solve.relative_residual = size > 0 ? left / size : 0;
  } else {
    const double tolerance = tolerance_ * size / left;
    if (!solve_with_factor(H, residual_, rest_, tolerance, solve)) {
      report.factorized = true;
      solve.indefinite = !solver_->factorize(H);
      if (solve.indefinite) return report;
      const int before = solve.products;
      solve = solver_->solve(residual_, rest_, tolerance);
      solve.products += before;
      digits_ = rate_ = 0;
      if (const Cholesky* factor = as_cholesky(*solver_)) {
        spent_ = factor->substitutions_per_factorization();
        note(solve, tolerance);
      }
    }
    solve.relative_residual *= left / size;
    add(1, rest_, x);
  }
  solve.products += 1 + static_cast<int>(last_.size());
  if (solve.ok) remember(x);
  return report;
}

bool SequenceSolver::solve_with_factor(const BlockSparse& H, std::span<const double> b, std::span<double> x,
                                       double tolerance, SolveReport& report) {
  if (is_worn()) return false;
  by_factor_.factorize(H);
  report = by_factor_.solve(b, x, tolerance);
  note(report, tolerance);
  return report.ok;
}

void SequenceSolver::note(const SolveReport& report, double tolerance) {
  const double digits = std::max(1e-3, -std::log10(std::max(tolerance, report.relative_residual)));
  const int substitutions = std::max(1, report.iterations);
  rate_ = substitutions / digits;
  spent_ += substitutions;
  digits_ += digits;
}

// The mean cost per digit decreases while the next digit costs less.
bool SequenceSolver::is_worn() const { return digits_ == 0 || rate_ > spent_ / digits_; }

// Orthogonalizes by modified Gram-Schmidt in the inner product of H [Fischer 1998].
void SequenceSolver::project(const BlockSparse& H, std::span<const double> b, std::span<double> x) {
  std::fill(x.begin(), x.end(), 0.0);
  for (std::vector<Vector>* vectors : {&basis_, &image_}) vectors->resize(kRemembered);
  for (size_t i = 0; i < last_.size(); ++i) {
    Vector &v = basis_[i], &Hv = image_[i];
    v = last_[i];
    Hv.resize(v.size());
    H.multiply(v, Hv);
    const double whole = dot(v, Hv);
    for (size_t j = 0; j < i; ++j) {
      const double along = dot(basis_[j], Hv);
      add(-along, basis_[j], v);
      add(-along, image_[j], Hv);
    }
    const double own = dot(v, Hv);
    const double inverse_length = own > 1e-12 * whole ? 1 / std::sqrt(own) : 0;  // 0: linearly dependent
    scale(inverse_length, v);
    scale(inverse_length, Hv);
    add(dot(v, b), v, x);
  }
}

void SequenceSolver::remember(std::span<const double> x) {
  Vector oldest;
  if (last_.size() == kRemembered) oldest = std::move(last_.back()), last_.pop_back();
  oldest.assign(x.begin(), x.end());
  last_.insert(last_.begin(), std::move(oldest));
}

}  // namespace aspic
