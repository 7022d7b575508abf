// Stress and Hessian of an isotropic energy density psi(s) of the principal stretches s, F = U diag(s) V' [Smith 2019].
#pragma once
#include <array>

#include "math/svd3.h"

namespace aspic {

template <class T>
struct StretchDerivatives {
  Vec3<T> first;            // dpsi/ds_i
  std::array<T, 9> second;  // d2psi/ds_i ds_j
  Vec3<T> difference;       // (psi_i - psi_j) / (s_i - s_j), its limit for s_i = s_j; i, j are the indices other than k
};

template <class T>
Mat3<T> stress_of_stretches(const Svd3<T>& f, const Vec3<T>& first) {
  Mat3<T> P;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      P(r, c) = first[0] * f.U(r, 0) * f.V(c, 0) + first[1] * f.U(r, 1) * f.V(c, 1) + first[2] * f.U(r, 2) * f.V(c, 2);
  return P;
}

// H += x vec(A) vec(B)'
template <class T>
void add_outer(const T& x, const Mat3<T>& A, const Mat3<T>& B, Mat9<T>& H) {
  for (int c = 0; c < 9; ++c)
    for (int r = 0; r < 9; ++r) H(r, c) = H(r, c) + x * A.a[r] * B.a[c];
}

// The stretches couple; each pair i < j of axes has a flip u_i v_j' + u_j v_i' with the eigenvalue (psi_i - psi_j) /
// (s_i - s_j) and a twist u_i v_j' - u_j v_i' with the eigenvalue (psi_i + psi_j) / (s_i + s_j).
template <class T>
Mat9<T> hessian_of_stretches(const Svd3<T>& f, const StretchDerivatives<T>& d) {
  const auto dyad = [&f](int i, int j) {
    Mat3<T> A;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) A(r, c) = f.U(r, i) * f.V(c, j);
    return A;
  };
  Mat9<T> H;
  for (T& x : H.a) x = T(0.0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) add_outer(d.second[i + 3 * j], dyad(i, i), dyad(j, j), H);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Mat3<T> A = dyad(i, j), B = dyad(j, i), flip = A + B, twist = A - B;
    add_outer(T(0.5) * d.difference[k], flip, flip, H);
    add_outer(T(0.5) * (d.first[i] + d.first[j]) / (f.s[i] + f.s[j]), twist, twist, H);
  }
  return H;
}

}  // namespace aspic
