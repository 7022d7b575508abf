// Eigenvalues and eigenvectors of a small symmetric matrix by Jacobi's method [Golub 2013, sec. 8.5].
#pragma once
#include <array>
#include <limits>

#include "math/pack.h"

namespace aspic {

// A = sum values[k] v_k v_k', where v_k = column k of `vectors` (column-major). Orthonormal and unordered.
template <int N, class T = double>
struct SymmetricEigen {
  std::array<T, N> values;
  std::array<T, N * N> vectors;
};

template <class T>
struct PlaneRotation {
  T sin, cos;
};

// Returns the rotation by at most pi/4 that diagonalizes [[app, apq], [apq, aqq]], or the identity where `active` is
// not positive.
template <class T>
PlaneRotation<T> jacobi_rotation(const T& app, const T& aqq, const T& apq, const T& active) {
  const T zeta = (aqq - app) / (T(2.0) * where_positive(active, apq, T(1.0)));
  const T sign = where_positive(-zeta, T(-1.0), T(1.0));
  const T tan = where_positive(active, sign / (abs(zeta) + sqrt(T(1.0) + zeta * zeta)), T(0.0));
  const T cos = T(1.0) / sqrt(T(1.0) + tan * tan);
  return {tan * cos, cos};
}

// (x, y) <- (cos x - sin y, sin x + cos y)
template <class T>
void rotate(const PlaneRotation<T>& r, T& x, T& y) {
  const T z = r.cos * x - r.sin * y;
  y = r.sin * x + r.cos * y;
  x = z;
}

// Requires that A is symmetric and column-major. Lanes that are not finite return undefined values.
template <int N, class T>
SymmetricEigen<N, T> symmetric_eigen(std::array<T, N * N> A) {
  constexpr int kMaxSweeps = 30;  // convergence is quadratic; 6 to 8 are typical
  SymmetricEigen<N, T> e;
  for (int i = 0; i < N * N; ++i) e.vectors[i] = T(i % (N + 1) == 0 ? 1.0 : 0.0);
  T scale = T(0.0);
  for (const T& a : A) scale = max(scale, abs(a));
  const T negligible = T(std::numeric_limits<double>::epsilon() / 16) * scale;

  bool rotated = true;
  for (int sweep = 0; rotated && sweep < kMaxSweeps; ++sweep) {
    rotated = false;
    for (int q = 1; q < N; ++q)
      for (int p = 0; p < q; ++p) {
        const T active = abs(A[p + N * q]) - negligible;
        if (!any_positive(active)) continue;
        rotated = true;
        const PlaneRotation<T> r = jacobi_rotation(A[p + N * p], A[q + N * q], A[p + N * q], active);
        for (int k = 0; k < N; ++k) rotate(r, A[k + N * p], A[k + N * q]);
        for (int k = 0; k < N; ++k) rotate(r, A[p + N * k], A[q + N * k]);
        for (int k = 0; k < N; ++k) rotate(r, e.vectors[k + N * p], e.vectors[k + N * q]);
      }
  }
  for (int i = 0; i < N; ++i) e.values[i] = A[i * (N + 1)];
  return e;
}

extern template SymmetricEigen<3, double> symmetric_eigen<3, double>(
    std::array<double, 9> A);  // compiled once, as in small.h

}  // namespace aspic
