// A material defined by its energy density psi(I1, J), I1 = tr(F'F) = |F|^2, J = det F.
//   P = 2 psi_I F + psi_J cof F
//   H = 2 psi_I Id + psi_J d2J/dF2 + psi_JJ g g' + 4 psi_II f f' + 2 psi_IJ (f g' + g f'),  f = vec F, g = vec cof F
#pragma once
#include "math/small.h"

namespace aspic {

// Derivatives of psi(I1, J). Densities that are linear in I1 (psi_II = psi_IJ = 0) return LawDerivativesLinearInI1.
template <class T>
struct LawDerivatives {
  T dI, dJ, dII, dIJ, dJJ;
};
template <class T>
struct LawDerivativesLinearInI1 {
  T dI, dJ, dJJ;
};

// H += s d2(det F)/dF2. The block of columns c and c+2 is the matrix of v -> f_(c+1) x v.
template <class T>
void add_determinant_hessian(const Mat3<T>& F, const T& s, Mat9<T>& H) {
  for (int c = 0; c < 3; ++c) {
    const int u = (c + 1) % 3, v = (c + 2) % 3;
    for (int r = 0; r < 3; ++r) {
      const int p = (r + 1) % 3, q = (r + 2) % 3;
      const T x = s * F(q, u);
      H(p + 3 * c, r + 3 * v) = H(p + 3 * c, r + 3 * v) + x;
      H(r + 3 * v, p + 3 * c) = H(r + 3 * v, p + 3 * c) + x;
      H(r + 3 * c, p + 3 * v) = H(r + 3 * c, p + 3 * v) - x;
      H(p + 3 * v, r + 3 * c) = H(p + 3 * v, r + 3 * c) - x;
    }
  }
}

// s Id + a x x'
template <class T>
Mat9<T> identity_plus_outer(const T& s, const T& a, const Mat3<T>& x) {
  const Mat3<T> ax = a * x;
  Mat9<T> H;
  for (int c = 0; c < 9; ++c) {
    for (int r = c; r < 9; ++r) H(r, c) = H(c, r) = ax.a[r] * x.a[c];
    H(c, c) = H(c, c) + s;
  }
  return H;
}
// s Id + a x x' + y z' + z y'
template <class T>
Mat9<T> identity_plus_outer(const T& s, const T& a, const Mat3<T>& x, const Mat3<T>& y, const Mat3<T>& z) {
  const Mat3<T> ax = a * x;
  Mat9<T> H;
  for (int c = 0; c < 9; ++c) {
    for (int r = c; r < 9; ++r) H(r, c) = H(c, r) = ax.a[r] * x.a[c] + (y.a[r] * z.a[c] + z.a[r] * y.a[c]);
    H(c, c) = H(c, c) + s;
  }
  return H;
}

template <class T>
Mat9<T> law_hessian(const Mat3<T>& F, const LawDerivativesLinearInI1<T>& d) {
  Mat9<T> H = identity_plus_outer(d.dI + d.dI, d.dJJ, cofactor(F));
  add_determinant_hessian(F, d.dJ, H);
  return H;
}
template <class T>
Mat9<T> law_hessian(const Mat3<T>& F, const LawDerivatives<T>& d) {
  const Mat3<T> g = cofactor(F), y = (d.dIJ + d.dIJ) * F + (T(0.5) * d.dJJ) * g;
  Mat9<T> H = identity_plus_outer(d.dI + d.dI, T(4.0) * d.dII, F, y, g);
  add_determinant_hessian(F, d.dJ, H);
  return H;
}

template <class L>
struct FromInvariants : L {
  using Law = L;
  template <class T>
  using Params = typename Law::template Params<T>;

  template <class T>
  static auto law_derivatives(const Mat3<T>& F, const Params<T>& p) {
    return Law::derivatives(squared_norm(F), determinant(F), p);
  }

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    return Law::energy(squared_norm(F), determinant(F), p);
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    const auto d = law_derivatives(F, p);
    return (d.dI + d.dI) * F + d.dJ * cofactor(F);
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    return law_hessian(F, law_derivatives(F, p));
  }
};

}  // namespace aspic
