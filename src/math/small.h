// Small dense matrices and vectors over any scalar T: double, Pack or Jet. Matrices are column-major, so `a` is vec(F).
#pragma once
#include <cmath>

namespace aspic {

template <class T>
struct Vec3 {
  T a[3];
  T& operator[](int i) { return a[i]; }
  const T& operator[](int i) const { return a[i]; }
};

template <class T>
struct Mat3 {
  T a[9];
  T& operator()(int r, int c) { return a[r + 3 * c]; }
  const T& operator()(int r, int c) const { return a[r + 3 * c]; }
};

// d vec(P) / d vec(F): a symmetric 9 x 9 matrix, column-major.
template <class T>
struct Mat9 {
  T a[81];
  T& operator()(int r, int c) { return a[r + 9 * c]; }
  const T& operator()(int r, int c) const { return a[r + 9 * c]; }
};

using Vec3d = Vec3<double>;
using Mat3d = Mat3<double>;
using Mat9d = Mat9<double>;

template <class T>
Vec3<T> operator+(const Vec3<T>& x, const Vec3<T>& y) {
  return {{x[0] + y[0], x[1] + y[1], x[2] + y[2]}};
}
template <class T>
Vec3<T> operator-(const Vec3<T>& x, const Vec3<T>& y) {
  return {{x[0] - y[0], x[1] - y[1], x[2] - y[2]}};
}
template <class T>
Vec3<T> operator*(const T& s, const Vec3<T>& x) {
  return {{s * x[0], s * x[1], s * x[2]}};
}
template <class T>
T dot(const Vec3<T>& x, const Vec3<T>& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
template <class T>
T squared_norm(const Vec3<T>& x) {
  return dot(x, x);
}
inline double norm(const Vec3d& x) { return std::sqrt(dot(x, x)); }
template <class T>
Vec3<T> cross(const Vec3<T>& x, const Vec3<T>& y) {
  return {{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]}};
}

template <class T>
Mat3<T> identity3() {
  Mat3<T> I;
  for (int i = 0; i < 9; ++i) I.a[i] = T(i % 4 == 0 ? 1.0 : 0.0);
  return I;
}
template <class T>
Mat3<T> operator+(const Mat3<T>& A, const Mat3<T>& B) {
  Mat3<T> C;
  for (int i = 0; i < 9; ++i) C.a[i] = A.a[i] + B.a[i];
  return C;
}
template <class T>
Mat3<T> operator-(const Mat3<T>& A, const Mat3<T>& B) {
  Mat3<T> C;
  for (int i = 0; i < 9; ++i) C.a[i] = A.a[i] - B.a[i];
  return C;
}
template <class T>
Mat3<T> operator*(const T& s, const Mat3<T>& A) {
  Mat3<T> B;
  for (int i = 0; i < 9; ++i) B.a[i] = s * A.a[i];
  return B;
}
template <class T>
[[gnu::always_inline]] inline Mat3<T> product(const Mat3<T>& A, const Mat3<T>& B) {
  Mat3<T> C;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) C(r, c) = A(r, 0) * B(0, c) + A(r, 1) * B(1, c) + A(r, 2) * B(2, c);
  return C;
}
template <class T>
Mat3<T> operator*(const Mat3<T>& A, const Mat3<T>& B) {
  return product(A, B);
}
// Always inlined. A call would get the code of any file, because the linker keeps one of them, and files round
// differently.
[[gnu::always_inline]] inline Mat3d operator*(const Mat3d& A, const Mat3d& B) { return product(A, B); }
template <class T>
Vec3<T> operator*(const Mat3<T>& A, const Vec3<T>& x) {
  Vec3<T> y;
  for (int r = 0; r < 3; ++r) y[r] = A(r, 0) * x[0] + A(r, 1) * x[1] + A(r, 2) * x[2];
  return y;
}
template <class T>
Mat3<T> transpose(const Mat3<T>& A) {
  Mat3<T> B;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) B(r, c) = A(c, r);
  return B;
}
template <class T>
T trace(const Mat3<T>& A) {
  return A(0, 0) + A(1, 1) + A(2, 2);
}
// A : B, the sum of the products of corresponding entries.
template <class T>
T inner(const Mat3<T>& A, const Mat3<T>& B) {
  T s = A.a[0] * B.a[0];
  for (int i = 1; i < 9; ++i) s = s + A.a[i] * B.a[i];
  return s;
}
template <class T>
T squared_norm(const Mat3<T>& A) {
  return inner(A, A);
}
// d det(F) / dF. Its columns are cross products of the columns of F.
template <class T>
Mat3<T> cofactor(const Mat3<T>& F) {
  Mat3<T> C;
  for (int c = 0; c < 3; ++c) {
    const int u = (c + 1) % 3, v = (c + 2) % 3;
    for (int r = 0; r < 3; ++r) {
      const int p = (r + 1) % 3, q = (r + 2) % 3;
      C(r, c) = F(p, u) * F(q, v) - F(q, u) * F(p, v);
    }
  }
  return C;
}
template <class T>
T determinant(const Mat3<T>& F) {
  return F(0, 0) * (F(1, 1) * F(2, 2) - F(2, 1) * F(1, 2)) + F(1, 0) * (F(2, 1) * F(0, 2) - F(0, 1) * F(2, 2)) +
         F(2, 0) * (F(0, 1) * F(1, 2) - F(1, 1) * F(0, 2));
}
template <class T>
Mat3<T> inverse(const Mat3<T>& A) {
  return (T(1.0) / determinant(A)) * transpose(cofactor(A));
}
// Returns the matrix with the given columns.
template <class T>
Mat3<T> from_columns(const Vec3<T>& x, const Vec3<T>& y, const Vec3<T>& z) {
  return {{x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]}};
}

template <class T>
Mat3<T> outer(const Vec3<T>& a, const Vec3<T>& b) {  // a b'
  return from_columns(b[0] * a, b[1] * a, b[2] * a);
}

// Compiled once, for the same reason as the product of doubles.
extern template Mat3d inverse(const Mat3d& A);

}  // namespace aspic
