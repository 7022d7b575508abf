#include "linalg/conjugate_gradient.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "math/eigen3.h"

namespace aspic {

bool invert_positive_definite(const Mat3d& A, Mat3d& inverse) {
  // A = L D L' with unit lower L; positive definite when all of D is positive. NaN fails too.
  const double d0 = A(0, 0);
  if (!(d0 > 0)) return false;
  const double l10 = A(1, 0) / d0, l20 = A(2, 0) / d0;
  const double d1 = A(1, 1) - l10 * A(1, 0);
  if (!(d1 > 0)) return false;
  const double e21 = A(2, 1) - l20 * A(1, 0), l21 = e21 / d1;
  const double d2 = A(2, 2) - l20 * A(2, 0) - l21 * e21;
  if (!(d2 > 0)) return false;
  const double m20 = l10 * l21 - l20;  // L^-1 = [1; -l10 1; m20 -l21 1]
  const double i0 = 1 / d0, i1 = 1 / d1, i2 = 1 / d2;
  inverse(0, 0) = i0 + l10 * l10 * i1 + m20 * m20 * i2;
  inverse(1, 0) = inverse(0, 1) = -l10 * i1 - m20 * l21 * i2;
  inverse(2, 0) = inverse(0, 2) = m20 * i2;
  inverse(1, 1) = i1 + l21 * l21 * i2;
  inverse(2, 1) = inverse(1, 2) = -l21 * i2;
  inverse(2, 2) = i2;
  return std::isfinite(trace(inverse));
}

bool invert_made_definite(const Mat3d& A, Mat3d& inverse) {
  if (invert_positive_definite(A, inverse)) return true;
  if (!std::isfinite(squared_norm(A)) || squared_norm(A) == 0) return false;
  constexpr double kFloor = 1e-6;
  const Eigen3 e = symmetric_eigen(A);
  const double largest = std::max(std::abs(e.values[0]), std::abs(e.values[2]));
  inverse = {};
  for (int k = 0; k < 3; ++k) {
    const double l = std::max(std::abs(e.values[k]), kFloor * largest);
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) inverse(r, c) += e.vectors(r, k) * e.vectors(c, k) / l;
  }
  return true;
}

void multiply_blocks(std::span<const Mat3d> blocks, std::span<const double> r, std::span<double> z) {
  ASPIC_CHECK(r.size() == 3 * blocks.size() && z.size() == r.size());
  for (size_t i = 0; i < blocks.size(); ++i) {
    const Vec3d product = blocks[i] * Vec3d{{r[3 * i], r[3 * i + 1], r[3 * i + 2]}};
    std::copy_n(product.a, 3, &z[3 * i]);
  }
}

void ConjugateGradient::analyze(const BlockPattern& pattern) {
  const size_t rows = pattern.rows();
  H_ = nullptr;
  inverse_diagonal_.resize(rows);
  for (std::vector<double>* v : {&r_, &z_, &p_, &q_}) v->resize(3 * rows);
  partial_.resize((rows + kChunkSize - 1) / kChunkSize);
}

bool ConjugateGradient::factorize(const BlockSparse& H) {
  ASPIC_CHECK(H.pattern->rows() == static_cast<int>(inverse_diagonal_.size()));
  H_ = &H;
  std::atomic<bool> definite = true;
  const auto invert = blocks_ == Blocks::made_definite ? invert_made_definite : invert_positive_definite;
  auto invert_rows = [&](int first, int last) {
    for (int row = first; row < last; ++row)
      if (!invert(H.block[H.pattern->diagonal(row)], inverse_diagonal_[row])) definite = false;
  };
  parallel_chunks(H.pattern->rows(), invert_rows);
  if (!definite) H_ = nullptr;
  return definite;
}

SolveReport ConjugateGradient::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  ASPIC_CHECK(H_ && b.size() == r_.size() && x.size() == b.size());
  SolveReport report;
  std::fill(x.begin(), x.end(), 0.0);
  std::fill(q_.begin(), q_.end(), 0.0);  // H x
  Sums sums = begin(b);
  const double b_norm = std::sqrt(sums.rr);
  if (b_norm == 0) {
    report.ok = true;
    return report;
  }
  double last_measured = b_norm;
  for (; report.iterations < max_iterations_; ++report.iterations) {
    report.stopped = report.iterations > 0 && deadline_.has_passed();
    if (report.stopped) return report;
    H_->multiply(p_, q_);
    ++report.products;
    const double curvature = p_dot_q();
    if (!(curvature > 0)) {
      report.indefinite = curvature <= 0;  // NaN is neither
      if (report.iterations == 0) std::copy(z_.begin(), z_.end(), x.begin());
      break;
    }
    const double rz = sums.rz;
    sums = advance(x, rz / curvature);
    if (std::sqrt(sums.rr) <= tolerance * b_norm) {
      // The recurrence drifts from the true residual by round-off: measure, and go on from there if need be.
      H_->multiply(x, q_);
      ++report.products;
      sums = begin(b);
      const double measured = std::sqrt(sums.rr);
      const bool stagnates = !(measured < 0.5 * last_measured);
      report.ok = measured <= tolerance * b_norm;
      if (report.ok || stagnates) {
        ++report.iterations;
        report.relative_residual = measured / b_norm;
        return report;
      }
      last_measured = measured;
      continue;
    }
    const double beta = sums.rz / rz;
    auto turn = [&](int first, int last) {
      for (int i = 3 * first; i < 3 * last; ++i) p_[i] = z_[i] + beta * p_[i];
    };
    parallel_chunks(H_->pattern->rows(), turn);
  }
  H_->multiply(x, q_);
  ++report.products;
  report.relative_residual = std::sqrt(begin(b).rr) / b_norm;
  report.ok = !report.indefinite && report.relative_residual <= tolerance;
  return report;
}

double ConjugateGradient::p_dot_q() {
  auto dot = [this](int first, int last) {
    double sum = 0;
    for (int i = 3 * first; i < 3 * last; ++i) sum += p_[i] * q_[i];
    partial_[first / kChunkSize].rr = sum;
  };
  parallel_chunks(H_->pattern->rows(), dot);
  return add_partial_sums().rr;
}

ConjugateGradient::Sums ConjugateGradient::advance(std::span<double> x, double alpha) {
  auto step = [&](int first, int last) {
    for (int i = 3 * first; i < 3 * last; ++i) x[i] += alpha * p_[i], r_[i] -= alpha * q_[i];
    precondition(first, last, partial_[first / kChunkSize]);
  };
  parallel_chunks(H_->pattern->rows(), step);
  return add_partial_sums();
}

ConjugateGradient::Sums ConjugateGradient::begin(std::span<const double> b) {
  auto step = [&](int first, int last) {
    for (int i = 3 * first; i < 3 * last; ++i) r_[i] = b[i] - q_[i];
    precondition(first, last, partial_[first / kChunkSize]);
    std::copy(z_.begin() + 3 * first, z_.begin() + 3 * last, p_.begin() + 3 * first);
  };
  parallel_chunks(H_->pattern->rows(), step);
  return add_partial_sums();
}

void ConjugateGradient::precondition(int first, int last, Sums& sums) {
  sums = {};
  for (int row = first; row < last; ++row) {
    const double* r = &r_[3 * static_cast<size_t>(row)];
    double* z = &z_[3 * static_cast<size_t>(row)];
    const Mat3d& M = inverse_diagonal_[row];
    for (int k = 0; k < 3; ++k) z[k] = M(k, 0) * r[0] + M(k, 1) * r[1] + M(k, 2) * r[2];
    sums.rr += r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
    sums.rz += r[0] * z[0] + r[1] * z[1] + r[2] * z[2];
  }
}

ConjugateGradient::Sums ConjugateGradient::add_partial_sums() const {
  Sums total;
  for (const Sums& part : partial_) total.rr += part.rr, total.rz += part.rz;
  return total;
}

}  // namespace aspic
