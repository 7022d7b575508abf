// A material defined by psi = W1(I1bar) + W2(I2bar) + U1(I1) + U2(I2) + V(J); +inf for J <= 0.
//   I1 = |F|^2, I2 = |cof F|^2 = (I1^2 - |F'F|^2) / 2, I1bar = J^(-2/3) I1, I2bar = J^(-4/3) I2
//   P = 2 psi_1 F + psi_2 G + psi_J g,   G = dI2/dF = 2 F (I1 Id - F'F),   g = cof F
//   H = 2 psi_1 Id + psi_2 d2I2/dF2 + psi_J d2J/dF2 + 4 psi_11 f f' + psi_22 G G' + psi_JJ g g'
//       + 2 psi_1J (f g' + g f') + psi_2J (G g' + g G')
#pragma once
#include "material/barrier.h"
#include "material/convex_spline.h"
#include "material/isochoric.h"
#include "material/second_piola.h"

namespace aspic {

// L defines Params<T> and the five functions with their derivatives: W1(I1bar, p) and so on.
template <class L>
struct FromTwoInvariants : L {
  using TwoInvariantLaw = L;
  template <class T>
  using Params = typename L::template Params<T>;

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    return infinite_unless_positive(determinant(F), of_minors(F, cofactor(F), determinant(F), p));
  }
  // Returns psi as a function of F, cof F and det F. If it is convex in these as independent variables, psi is
  // polyconvex.
  template <class T>
  static T of_minors(const Mat3<T>& F, const Mat3<T>& cof, const T& J, const Params<T>& p) {
    const T s = isochoric_scale(J), I1 = squared_norm(F), I2 = squared_norm(cof);
    return L::W1(s * I1, p).value + L::W2(s * s * I2, p).value + L::U1(I1, p).value + L::U2(I2, p).value +
           L::V(J, p).value;
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    const Derivatives<T> d(F, p);
    return (d.first.dI + d.first.dI) * F + d.first.dJ * d.g + d.second.dI * (F * d.S);
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    const Derivatives<T> d(F, p);
    const Mat3<T> G = F * d.S;
    const Mat3<T> y = (d.first.dIJ + d.first.dIJ) * F + (T(0.5) * d.first.dJJ) * d.g + d.second.dIJ * G;
    Mat9<T> H = identity_plus_outer(d.first.dI + d.first.dI, T(4.0) * (d.first.dII + d.second.dI), F, y, d.g);
    add_determinant_hessian(F, d.first.dJ, H);
    // G = F S with dS = -2 dC + 2 dI1 Id. The identity plus outer products above include the second part, 4 f f'.
    add_product_hessian(F, d.second.dI * d.S, T(-2.0) * d.second.dI, H);
    const Mat3<T> wG = d.second.dII * G;
    for (int c = 0; c < 9; ++c)
      for (int r = 0; r < 9; ++r) H(r, c) = H(r, c) + (r < c ? wG.a[r] * G.a[c] : wG.a[c] * G.a[r]);
    return H;
  }

 private:
  template <class T>
  struct Derivatives {
    Mat3<T> g, S;             // cof F, 2 (I1 Id - C)
    LawDerivatives<T> first;  // derivatives with respect to I1 and J, including all of psi_J and psi_JJ
    struct {
      T dI, dII, dIJ;
    } second;  // psi_2, psi_22, psi_2J

    Derivatives(const Mat3<T>& F, const Params<T>& p)
        : g(cofactor(F)), S(T(2.0) * (squared_norm(F) * identity3<T>() - transpose(F) * F)) {
      const T J = determinant(F), r = T(1.0) / J, s = isochoric_scale(J), s2 = s * s;
      const T I1 = squared_norm(F), I2 = squared_norm(g);
      const Curve<T> W1 = L::W1(s * I1, p), W2 = L::W2(s2 * I2, p);
      const Curve<T> U1 = L::U1(I1, p), U2 = L::U2(I2, p), V = L::V(J, p);
      const T dI2bar_dJ = T(-4.0 / 3.0) * s2 * I2 * r;
      first = isochoric_derivatives(I1, J, W1.slope, W1.curvature, T(0.0));
      first.dI = first.dI + U1.slope;
      first.dII = first.dII + U1.curvature;
      first.dJ = first.dJ + V.slope + W2.slope * dI2bar_dJ;
      first.dJJ =
          first.dJJ + V.curvature + W2.curvature * dI2bar_dJ * dI2bar_dJ - T(7.0 / 3.0) * W2.slope * dI2bar_dJ * r;
      second = {W2.slope * s2 + U2.slope, W2.curvature * s2 * s2 + U2.curvature,
                W2.curvature * s2 * dI2bar_dJ - T(4.0 / 3.0) * W2.slope * s2 * r};
    }
  };
};

}  // namespace aspic
