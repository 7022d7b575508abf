#include "ranks/rank_cg.h"

#include <algorithm>
#include <cmath>

#include "linalg/block_jacobi.h"
#include "math/vectors.h"

namespace aspic::distributed {
namespace {

constexpr double kGrowth = 1.3;

}  // namespace

RankCg::RankCg(const Share& share, Halo& halo, int max_iterations)
    : share_(share),
      halo_(halo),
      max_iterations_(max_iterations),
      preconditioner_(std::make_unique<BlockJacobi>(BlockJacobi::Blocks::modified)) {}

RankCg::RankCg(const Share& share, Halo& halo, std::unique_ptr<RankMultigrid> multigrid, int max_iterations)
    : share_(share), halo_(halo), max_iterations_(max_iterations), multigrid_(multigrid.get()) {
  preconditioner_ = std::move(multigrid);
}

void RankCg::analyze(const BlockPattern& pattern) {
  own_ = 3 * share_.own(pattern.rows());
  preconditioner_->analyze(pattern);
  is_made_ = false;
  for (auto* v : {&r_, &z_, &p_, &q_}) v->resize(3 * static_cast<size_t>(pattern.rows()));
}

bool RankCg::factorize(const BlockSparse& H) {
  H_ = &H;
  const bool is_kept = is_made_ && multigrid_ && rate_ <= kGrowth * first_rate_;
  if (is_kept) return is_made_ = share_.all(multigrid_->follow(H));
  first_rate_ = rate_ = 0;
  return is_made_ = share_.all(preconditioner_->factorize(H));
}

double RankCg::dot(std::span<const double> a, std::span<const double> b) const {
  return share_.sum(aspic::dot(a.first(own_), b.first(own_)));
}

bool RankCg::start(std::span<const double> b, std::span<double> x) {
  std::fill(x.begin(), x.end(), 0.0);
  std::copy_n(b.begin(), own_, r_.begin());
  std::fill(r_.begin() + own_, r_.end(), 0.0);
  if (!multigrid_ || !multigrid_->start(r_, x)) return false;
  halo_.update(x);
  H_->multiply(x, q_);
  for (int i = 0; i < own_; ++i) r_[i] -= q_[i];
  return true;
}

void RankCg::precondition() {
  preconditioner_->apply(r_, z_);
  std::fill(z_.begin() + own_, z_.end(), 0.0);
}

double RankCg::advance(std::span<double> x, double rz, SolveReport& report) {
  halo_.update(p_);
  H_->multiply(p_, q_);
  ++report.products;
  const double curvature = dot(p_, q_);
  if (!(curvature > 0)) {
    report.indefinite = curvature <= 0;  // NaN is neither
    if (report.iterations == 0)
      for (int i = 0; i < own_; ++i) x[i] += z_[i];
    return 0;
  }
  const double alpha = rz / curvature;
  for (int i = 0; i < own_; ++i) x[i] += alpha * p_[i], r_[i] -= alpha * q_[i];
  ++report.iterations;
  return alpha;
}

void RankCg::turn(double alpha, double& rz) {
  const auto own = [this](const std::vector<double>& v) { return std::span(v).first(own_); };
  double sums[] = {aspic::dot(own(r_), own(z_)), aspic::dot(own(q_), own(z_))};
  share_.sum(sums);
  // Both are equal in exact arithmetic; the first tolerates a nonlinear preconditioner [Notay 2000].
  const double beta = multigrid_ ? -alpha * sums[1] / rz : sums[0] / rz;
  rz = sums[0];
  for (int i = 0; i < own_; ++i) p_[i] = z_[i] + beta * p_[i];
}

// A failed solve renews the preconditioner.
void RankCg::note_rate(const SolveReport& report) {
  rate_ = report.iterations / std::max(1e-3, -std::log10(report.relative_residual));
  if (first_rate_ == 0) first_rate_ = rate_;
  if (!report.ok) is_made_ = false;
}

SolveReport RankCg::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  TrafficCounts& traffic = halo_.traffic();
  const Traffic before = traffic.all;
  SolveReport report;
  const double b_norm = std::sqrt(dot(b, b));
  double residual = start(b, x) ? std::sqrt(dot(r_, r_)) : b_norm;
  precondition();
  p_ = z_;
  double rz = dot(r_, z_);
  while (residual > tolerance * b_norm && report.iterations < max_iterations_ && rz > 0) {
    const double alpha = advance(x, rz, report);
    if (alpha == 0) break;
    residual = std::sqrt(dot(r_, r_));
    if (residual <= tolerance * b_norm) break;
    precondition();
    turn(alpha, rz);
  }
  halo_.update(x);
  traffic.linear += traffic.all - before;
  traffic.linear.iterations += report.iterations;
  report.relative_residual = b_norm > 0 ? residual / b_norm : 0;
  report.ok = !report.indefinite && report.relative_residual <= tolerance;
  report.cycles = multigrid_ ? report.iterations : 0;
  note_rate(report);
  return report;
}

std::unique_ptr<LinearSolver> RankCg::make_semidefinite_solver() const {
  return std::make_unique<RankCg>(share_, halo_);
}

}  // namespace aspic::distributed
