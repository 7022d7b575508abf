#include "linalg/block_jacobi.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "math/eigen3.h"

namespace aspic {

bool BlockJacobi::factorize(const BlockSparse& H) {
  ASPIC_CHECK(H.pattern->rows() == static_cast<int>(inverse_.size()));
  std::atomic<bool> definite = true;
  const auto invert = blocks_ == Blocks::modified ? invert_modified : invert_positive_definite;
  parallel_chunks(H.pattern->rows(), [&](int first, int last) {
    for (int row = first; row < last; ++row)
      if (!invert(H.block[H.pattern->diagonal(row)], inverse_[row])) definite = false;
  });
  return definite;
}

void BlockJacobi::apply(std::span<const double> r, std::span<double> z) { multiply_blocks(inverse_, r, z); }

bool invert_positive_definite(const Mat3d& A, Mat3d& inverse) {
  // A = L D L' with unit lower triangular L. A is positive definite if all of D is positive. NaN fails too.
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

bool invert_modified(const Mat3d& A, Mat3d& inverse) {
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
  parallel_chunks(static_cast<int>(blocks.size()), [&](int first, int last) {
    for (size_t i = first; i < static_cast<size_t>(last); ++i) {
      const Vec3d product = blocks[i] * Vec3d{{r[3 * i], r[3 * i + 1], r[3 * i + 2]}};
      std::copy_n(product.a, 3, &z[3 * i]);
    }
  });
}

}  // namespace aspic
