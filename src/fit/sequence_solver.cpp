#include "fit/sequence_solver.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace aspic {
namespace {

constexpr size_t kRemembered = 6;  // solutions: more cost as many products as they save

double dot(std::span<const double> a, std::span<const double> b) {
  return parallel_sum(static_cast<int>(a.size()), [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) sum += a[i] * b[i];
    return sum;
  });
}
double norm(std::span<const double> a) { return std::sqrt(dot(a, a)); }

// y += s x
void add(double s, std::span<const double> x, std::span<double> y) {
  parallel_chunks(static_cast<int>(x.size()), [&](int first, int last) {
    for (int i = first; i < last; ++i) y[i] += s * x[i];
  });
}
void scale(double s, std::span<double> x) {
  for (double& xi : x) xi *= s;
}

}  // namespace

void SequenceSolver::begin() {
  last_.clear();
  solver_->begin();
}

SolveReport SequenceSolver::solve(const BlockSparse& H, std::span<const double> b, std::span<double> x) {
  for (Vector* v : {&residual_, &rest_}) v->resize(b.size());
  if (analyzed_version_ != H.pattern->version) solver_->analyze(*H.pattern);
  analyzed_version_ = H.pattern->version;
  SolveReport report;
  report.indefinite = !solver_->factorize(H);
  if (report.indefinite) return report;

  project(H, b, x);
  H.multiply(x, rest_);
  for (size_t i = 0; i < b.size(); ++i) residual_[i] = b[i] - rest_[i];
  const double size = norm(b), left = norm(residual_);
  if (left <= tolerance_ * size) {
    report.ok = true;
    report.relative_residual = size > 0 ? left / size : 0;
  } else {
    report = solver_->solve(residual_, rest_, tolerance_ * size / left);
    report.relative_residual *= left / size;
    add(1, rest_, x);
  }
  report.products += 1 + static_cast<int>(last_.size());
  if (report.ok) remember(x);
  return report;
}

// By modified Gram-Schmidt in the inner product of H [Fischer 1998].
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
    const double inverse_length = own > 1e-12 * whole ? 1 / std::sqrt(own) : 0;  // 0: nothing new in it
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
