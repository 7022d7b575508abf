#include "math/svd3.h"

#include <limits>

#include "math/symmetric_eigen.h"

namespace aspic {
namespace {

template <class T>
Vec3<T> column(const Mat3<T>& A, int c) {
  return {{A(0, c), A(1, c), A(2, c)}};
}

template <class T>
Vec3<T> select(const T& condition, const Vec3<T>& x, const Vec3<T>& y) {
  return {{where_positive(condition, x[0], y[0]), where_positive(condition, x[1], y[1]),
           where_positive(condition, x[2], y[2])}};
}

template <class T>
void rotate_columns(const PlaneRotation<T>& r, Mat3<T>& A, int i, int j) {
  for (int k = 0; k < 3; ++k) rotate(r, A(k, i), A(k, j));
}

// Where the condition is positive, swaps two columns and negates one: a rotation, which preserves the determinant.
template <class T>
void swap_columns(const T& condition, Mat3<T>& A, int i, int j) {
  for (int k = 0; k < 3; ++k) {
    const T x = A(k, i), y = A(k, j);
    A(k, i) = where_positive(condition, -y, x);
    A(k, j) = where_positive(condition, x, y);
  }
}

// Applies rotations to B and V until the columns of B are orthogonal to working precision.
template <class T>
void orthogonalize_columns(Mat3<T>& B, Mat3<T>& V) {
  constexpr int kMaxSweeps = 20;
  constexpr double kOrthogonal = std::numeric_limits<double>::epsilon();
  bool rotated = true;
  for (int sweep = 0; rotated && sweep < kMaxSweeps; ++sweep) {
    rotated = false;
    for (int j = 1; j < 3; ++j)
      for (int i = 0; i < j; ++i) {
        const Vec3<T> bi = column(B, i), bj = column(B, j);
        const T aii = dot(bi, bi), ajj = dot(bj, bj), aij = dot(bi, bj);
        const T active = abs(aij) - T(kOrthogonal) * sqrt(aii) * sqrt(ajj);
        if (!any_positive(active)) continue;
        rotated = true;
        const PlaneRotation<T> r = jacobi_rotation(aii, ajj, aij, active);
        rotate_columns(r, B, i, j);
        rotate_columns(r, V, i, j);
      }
  }
}

// Returns a unit vector perpendicular to u, from the coordinate axis that is closest to perpendicular.
template <class T>
Vec3<T> unit_perpendicular(const Vec3<T>& u) {
  const T x = abs(u[0]), y = abs(u[1]), z = abs(u[2]), zero = T(0.0), one = T(1.0);
  const T is_x = where_positive(y - x, where_positive(z - x, one, zero), zero);
  const T is_y = (one - is_x) * where_positive(y - z, zero, one);
  const Vec3<T> axis = {{is_x, is_y, one - is_x - is_y}};
  const Vec3<T> w = axis - dot(axis, u) * u;
  return (one / sqrt(dot(w, w))) * w;
}

// Returns x / length, or the other vector if the length is 0.
template <class T>
Vec3<T> unit(const Vec3<T>& x, const T& length, const Vec3<T>& other) {
  const T divisor = where_positive(length, length, T(1.0));
  return select(length, Vec3<T>{{x[0] / divisor, x[1] / divisor, x[2] / divisor}}, other);
}

template <class T>
Svd3<T> decomposition(const Mat3<T>& F) {
  T scale = T(0.0);  // scaling prevents overflow and underflow of squares
  for (const T& a : F.a) scale = max(scale, abs(a));
  scale = where_positive(scale, scale, T(1.0));
  Mat3<T> B, V = identity3<T>();
  for (int i = 0; i < 9; ++i) B.a[i] = F.a[i] / scale;
  orthogonalize_columns(B, V);

  const auto squared_length = [&B](int c) { return dot(column(B, c), column(B, c)); };
  for (const int i : {0, 1, 0}) {
    const T longer = squared_length(i + 1) - squared_length(i);
    swap_columns(longer, B, i, i + 1);
    swap_columns(longer, V, i, i + 1);
  }

  const T length0 = sqrt(squared_length(0)), length1 = sqrt(squared_length(1));
  const Vec3<T> u0 = unit(column(B, 0), length0, Vec3<T>{{T(1.0), T(0.0), T(0.0)}});
  const Vec3<T> u1 = unit(column(B, 1), length1, unit_perpendicular(u0));
  const Vec3<T> u2 = cross(u0, u1);
  return {from_columns(u0, u1, u2), {{scale * length0, scale * length1, scale * dot(u2, column(B, 2))}}, V};
}

}  // namespace

Svd3<double> svd3(const Mat3d& F) { return decomposition(F); }
Svd3<Pack> svd3(const Mat3<Pack>& F) { return decomposition(F); }

}  // namespace aspic
