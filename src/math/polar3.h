// Polar decomposition F = R S: R is the closest rotation, tr S is the sum of the (signed) singular values.
#pragma once
#include <limits>

#include "math/dual.h"
#include "math/jet.h"
#include "math/svd3.h"

namespace aspic {

template <class T>
Mat3<T> rotation(const Svd3<T>& f) {
  return f.U * transpose(f.V);
}

template <class T>
Mat3<T> closest_rotation(const Mat3<T>& F) {
  return rotation(svd3(F));
}
// Also computes the derivative: R' dR is the cross product with w, (tr S I - S) w = axis of R' dF - dF' R.
template <class T>
Mat3<Dual<T>> closest_rotation(const Mat3<Dual<T>>& F) {
  const Mat3<T> R = closest_rotation(values(F));
  const Mat3<T> S = transpose(R) * values(F), A = transpose(R) * rates(F);
  const Mat3<T> G = trace(S) * identity3<T>() - S;
  const T det = determinant(G), threshold = T(std::numeric_limits<double>::min());  // 0 where R is discontinuous
  const Vec3<T> axis = {{A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1)}};
  const Vec3<T> w = (T(1.0) / where_positive(det - threshold, det, threshold)) * (transpose(cofactor(G)) * axis);
  const T o = T(0.0);
  return dual_matrix(R, R * Mat3<T>{{o, w[2], -w[1], -w[2], o, w[0], w[1], -w[0], o}});
}

// H += scale dR/dF, where dR/dF = sum over i < j of w w' / (s_i + s_j), w = vec(u_i v_j' - u_j v_i'). R is
// discontinuous at s_i + s_j = 0, so the sum is bounded below by `threshold` to keep the result finite.
template <class T>
void add_rotation_gradient(const Svd3<T>& f, const T& scale, double threshold, Mat9<T>& H) {
  for (int j = 1; j < 3; ++j)
    for (int i = 0; i < j; ++i) {
      const T sum = f.s[i] + f.s[j];
      const T factor = scale / where_positive(sum - T(threshold), sum, T(threshold));
      Mat3<T> w;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) w(r, c) = f.U(r, i) * f.V(c, j) - f.U(r, j) * f.V(c, i);
      for (int c = 0; c < 9; ++c)
        for (int r = 0; r < 9; ++r) H(r, c) = H(r, c) + factor * w.a[r] * w.a[c];
    }
}

// tr S = s_0 + s_1 + s_2.
template <class T>
T stretch_trace(const Mat3<T>& F) {
  const Svd3<T> f = svd3(F);
  return f.s[0] + f.s[1] + f.s[2];
}

// tr S with derivatives: t = tr S is a root of (t^2 - I1)^2 / 4 - I2 - 2 J t, I1 = |F|^2, I2 = |cof F|^2. Each Newton
// step on the jet doubles the order of accuracy, so two steps give second derivatives.
template <class T>
Jet<T> stretch_trace(const Mat3<Jet<T>>& F) {
  Mat3<T> value;
  for (int i = 0; i < 9; ++i) value.a[i] = F.a[i].value;
  const Jet<T> I1 = squared_norm(F), I2 = squared_norm(cofactor(F)), J = determinant(F);
  Jet<T> t(stretch_trace(value));
  for (int step = 0; step < 2; ++step) {
    const Jet<T> q = 0.5 * (t * t - I1);
    t = t - (q * q - I2 - 2.0 * J * t) / (2.0 * (t * q - J));
  }
  return t;
}

}  // namespace aspic
