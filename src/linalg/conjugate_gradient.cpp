#include "linalg/conjugate_gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/parallel.h"
#include "math/vectors.h"

namespace aspic {
namespace {

// Relative residual above which the recurrence for the residual is accurate.
constexpr double kTrusted = 1e-6;
constexpr double kTolerable = 1.3;

}  // namespace

ConjugateGradient::ConjugateGradient(int max_iterations)
    : ConjugateGradient(std::make_unique<BlockJacobi>(), max_iterations) {}

ConjugateGradient::ConjugateGradient(std::unique_ptr<ApproximateInverse> preconditioner, int max_iterations)
    : preconditioner_(std::move(preconditioner)), max_iterations_(max_iterations) {
  lifted_.set_max_iterations(max_iterations);
}

void ConjugateGradient::set_max_iterations(int count) {
  max_iterations_ = count;
  lifted_.set_max_iterations(count);
}

void ConjugateGradient::set_stop(const StopToken& stop) {
  stop_ = stop;
  lifted_.set_stop(stop);
}

void ConjugateGradient::analyze(const BlockPattern& pattern) {
  const size_t rows = pattern.rows();
  H_ = nullptr;
  is_made_ = false;
  preconditioner_->analyze(pattern);
  for (std::vector<double>* v : {&r_, &z_, &p_, &q_}) v->resize(3 * rows);
}

bool ConjugateGradient::factorize(const BlockSparse& H) {
  ASPIC_CHECK(3 * static_cast<size_t>(H.pattern->rows()) == r_.size());
  const BlockSparse& matrix = is_lifted() ? lifted_.separate(H, *stiff_) : H;
  const bool is_kept = is_made_ && preconditioner_->is_multigrid() && rate_ <= kTolerable * first_rate_;
  if (!is_kept) {
    is_made_ = preconditioner_->factorize(matrix);
    first_rate_ = rate_ = 0;
  }
  H_ = is_made_ ? &H : nullptr;
  if (is_made_ && !correction_.factorize(matrix)) correction_.drop();  // the iteration detects negative curvature
  return is_made_;
}

SolveReport ConjugateGradient::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  ASPIC_CHECK(H_ && b.size() == r_.size() && x.size() == b.size());
  if (is_lifted()) return solve_lifted(b, x, tolerance);
  SolveReport report;
  std::fill(x.begin(), x.end(), 0.0);
  std::copy(b.begin(), b.end(), r_.begin());
  double residual = norm(r_);
  const double b_norm = residual;
  if (b_norm == 0) {
    report.ok = true;
    return report;
  }
  double last_measured = b_norm;
  precondition(report);
  p_ = z_;
  double rz = dot(r_, z_);
  bool is_measured = true;
  while (report.iterations < max_iterations_) {
    report.stopped = report.iterations > 0 && stop_.stopped();
    if (report.stopped) break;
    H_->multiply(p_, q_);
    ++report.products;
    const double curvature = dot(p_, q_);
    if (!(curvature > 0)) {
      report.indefinite = curvature <= 0;  // NaN is neither
      if (report.iterations == 0) std::copy(z_.begin(), z_.end(), x.begin());
      break;
    }
    const double alpha = rz / curvature;
    residual = advance(x, alpha);
    ++report.iterations;
    is_measured = false;
    if (residual <= tolerance * b_norm) {
      if (tolerance >= kTrusted) break;
      // The recurrence drifts from the true residual by round-off: compute it, and continue if necessary.
      residual = measure(b, x, report);
      is_measured = true;
      const bool stagnates = !(residual < 0.5 * last_measured);
      if (residual <= tolerance * b_norm || stagnates) break;
      last_measured = residual;
      precondition(report);
      p_ = z_;
      rz = dot(r_, z_);
      continue;
    }
    precondition(report);
    const double new_rz = dot(r_, z_);
    // Both are equal in exact arithmetic; the first tolerates a nonlinear preconditioner [Notay 2000].
    const double beta = preconditioner_->is_multigrid() ? -alpha * dot(q_, z_) / rz : new_rz / rz;
    rz = new_rz;
    turn(beta);
  }
  if (!is_measured && !report.stopped && tolerance < kTrusted) residual = measure(b, x, report);
  report.relative_residual = residual / b_norm;
  note_rate(report);
  report.ok = !report.indefinite && report.relative_residual <= tolerance;
  return report;
}

SolveReport ConjugateGradient::solve_lifted(std::span<const double> b, std::span<double> x, double tolerance) {
  int cycles = 0;
  SolveReport report = lifted_.solve(b, x, tolerance, [&](std::span<const double> r, std::span<double> z) {
    correction_.apply(*preconditioner_, r, z);
    cycles += preconditioner_->is_multigrid();
  });
  report.cycles = cycles;
  note_rate(report);
  return report;
}

void ConjugateGradient::note_rate(const SolveReport& report) {
  // Contact may make H indefinite: its rate would keep a hierarchy that was made for it.
  if (report.indefinite && !H_->stencils.empty()) {
    if (first_rate_ == 0) rate_ = std::numeric_limits<double>::infinity();
    return;
  }
  rate_ = report.iterations / std::max(1e-3, -std::log10(report.relative_residual));
  if (first_rate_ == 0) first_rate_ = rate_;
}

void ConjugateGradient::precondition(SolveReport& report) {
  correction_.apply(*preconditioner_, r_, z_);
  report.cycles += preconditioner_->is_multigrid();
}

double ConjugateGradient::measure(std::span<const double> b, std::span<const double> x, SolveReport& report) {
  H_->multiply(x, q_);
  ++report.products;
  return std::sqrt(parallel_sum(static_cast<int>(r_.size()), [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) r_[i] = b[i] - q_[i], sum += r_[i] * r_[i];
    return sum;
  }));
}

double ConjugateGradient::advance(std::span<double> x, double alpha) {
  return std::sqrt(parallel_sum(static_cast<int>(r_.size()), [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) {
      x[i] += alpha * p_[i];
      r_[i] -= alpha * q_[i];
      sum += r_[i] * r_[i];
    }
    return sum;
  }));
}

void ConjugateGradient::turn(double beta) {
  parallel_chunks(static_cast<int>(p_.size()), [&](int first, int last) {
    for (int i = first; i < last; ++i) p_[i] = z_[i] + beta * p_[i];
  });
}

}  // namespace aspic
