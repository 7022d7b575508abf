// Eigenvalues and eigenvectors of a small symmetric matrix by Jacobi's method [Golub 2013, sec. 8.5].
#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace aspic {

// A = sum values[k] v_k v_k', values ascending, v_k = column k of `vectors` (column-major), orthonormal.
template <int N>
struct SymmetricEigen {
  std::array<double, N> values;
  std::array<double, N * N> vectors;
};

// tan, sin and cos of the rotation that makes [[app, apq], [apq, aqq]] diagonal; |angle| <= pi/4.
struct JacobiRotation {
  double t, s, c;
};
inline JacobiRotation jacobi_rotation(double app, double aqq, double apq) {
  const double zeta = (aqq - app) / (2 * apq);
  const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::hypot(1.0, zeta));
  const double c = 1 / std::sqrt(1 + t * t);
  return {t, t * c, c};
}

// (x, y) <- (c x - s y, s x + c y)
inline void rotate(const JacobiRotation& r, double& x, double& y) {
  const double z = r.c * x - r.s * y;
  y = r.s * x + r.c * y;
  x = z;
}

// Reads all of the column-major A, which must be symmetric and finite.
template <int N>
SymmetricEigen<N> symmetric_eigen(std::array<double, N * N> A) {
  constexpr int kMaxSweeps = 30;  // quadratic convergence: 6 to 8 are typical
  SymmetricEigen<N> e{};
  for (int i = 0; i < N; ++i) e.vectors[i * (N + 1)] = 1;
  double scale = 0;
  for (const double a : A) scale = std::fmax(scale, std::abs(a));
  const double negligible = scale * std::numeric_limits<double>::epsilon() / 16;

  bool rotated = true;
  for (int sweep = 0; rotated && sweep < kMaxSweeps; ++sweep) {
    rotated = false;
    for (int q = 1; q < N; ++q)
      for (int p = 0; p < q; ++p) {
        if (!(std::abs(A[p + N * q]) > negligible)) continue;
        rotated = true;
        const JacobiRotation r = jacobi_rotation(A[p + N * p], A[q + N * q], A[p + N * q]);
        for (int k = 0; k < N; ++k) rotate(r, A[k + N * p], A[k + N * q]);
        for (int k = 0; k < N; ++k) rotate(r, A[p + N * k], A[q + N * k]);
        for (int k = 0; k < N; ++k) rotate(r, e.vectors[k + N * p], e.vectors[k + N * q]);
      }
  }

  for (int i = 0; i < N; ++i) e.values[i] = A[i * (N + 1)];
  for (int i = 0; i < N; ++i) {  // selection sort: N is small
    int least = i;
    for (int j = i + 1; j < N; ++j)
      if (e.values[j] < e.values[least]) least = j;
    if (least == i) continue;
    std::swap(e.values[i], e.values[least]);
    for (int k = 0; k < N; ++k) std::swap(e.vectors[k + N * i], e.vectors[k + N * least]);
  }
  return e;
}

}  // namespace aspic
