#include "distributed/rank_cg.h"

#include <algorithm>
#include <cmath>

#include "distributed/traffic.h"
#include "math/vectors.h"

namespace aspic::distributed {

void RankCg::analyze(const BlockPattern& pattern) {
  own_ = 3 * share_.own(pattern.rows());
  jacobi_.analyze(pattern);
  for (auto* v : {&r_, &z_, &p_, &q_}) v->resize(3 * static_cast<size_t>(pattern.rows()));
}

bool RankCg::factorize(const BlockSparse& H) {
  H_ = &H;
  return share_.all(jacobi_.factorize(H));
}

double RankCg::dot(std::span<const double> a, std::span<const double> b) const {
  return share_.sum(aspic::dot(a.first(own_), b.first(own_)));
}

void RankCg::precondition() {
  jacobi_.apply(r_, z_);
  std::fill(z_.begin() + own_, z_.end(), 0.0);
}

bool RankCg::advance(std::span<double> x, double rz, SolveReport& report) {
  halo_.update(p_);
  H_->multiply(p_, q_);
  ++report.products;
  const double curvature = dot(p_, q_);
  if (!(curvature > 0)) {
    report.indefinite = curvature <= 0;  // NaN is neither
    if (report.iterations == 0) std::copy(z_.begin(), z_.end(), x.begin());
    return false;
  }
  const double alpha = rz / curvature;
  for (int i = 0; i < own_; ++i) x[i] += alpha * p_[i], r_[i] -= alpha * q_[i];
  ++report.iterations;
  return true;
}

SolveReport RankCg::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  const Traffic before = own_traffic();
  SolveReport report;
  std::fill(x.begin(), x.end(), 0.0);
  std::copy_n(b.begin(), own_, r_.begin());
  std::fill(r_.begin() + own_, r_.end(), 0.0);
  const double b_norm = std::sqrt(dot(r_, r_));
  double residual = b_norm;
  precondition();
  p_ = z_;
  double rz = dot(r_, z_);
  while (residual > tolerance * b_norm && report.iterations < max_iterations_ && advance(x, rz, report)) {
    residual = std::sqrt(dot(r_, r_));
    precondition();
    const double next = dot(r_, z_), beta = next / rz;
    rz = next;
    for (int i = 0; i < own_; ++i) p_[i] = z_[i] + beta * p_[i];
  }
  halo_.update(x);
  linear_traffic() += own_traffic() - before;
  linear_traffic().iterations += report.iterations;
  report.relative_residual = b_norm > 0 ? residual / b_norm : 0;
  report.ok = !report.indefinite && report.relative_residual <= tolerance;
  return report;
}

std::unique_ptr<LinearSolver> RankCg::make_semidefinite_solver() const {
  return std::make_unique<RankCg>(share_, halo_);
}

}  // namespace aspic::distributed
