// Mooney-Rivlin solid: psi = c10 (I1bar - 3) + c01 (I2bar - 3) + K/2 (J - 1)^2; +inf for J <= 0.
//   I1bar = J^(-2/3) I1, I2bar = J^(-4/3) I2, I2 = |cof F|^2 = (I1^2 - |F'F|^2) / 2
#pragma once
#include "material/isochoric.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"
#include "material/second_piola.h"

namespace aspic {

struct MooneyRivlin {
  template <class T>
  struct Params {
    T c10, c01, bulk;  // [Pa]
  };

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    const T J = determinant(F), s = isochoric_scale(J);
    const T W1 = p.c10 * (s * squared_norm(F) - T(3.0));
    const T W2 = p.c01 * (s * s * squared_norm(cofactor(F)) - T(3.0));
    return isochoric_energy(J, W1 + W2, p.bulk);
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    const Derivatives<T> d(F, p);
    return (d.law.dI + d.law.dI) * F + d.law.dJ * cofactor(F) + d.dI2 * gradient_of_I2(F);
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    const Derivatives<T> d(F, p);
    const Mat3<T> g = cofactor(F), S = stress_of_I2(F);
    const Mat3<T> y = (d.law.dIJ + d.law.dIJ) * F + (T(0.5) * d.law.dJJ) * g + d.dI2J * (F * S);
    Mat9<T> H = identity_plus_outer(d.law.dI + d.law.dI, T(4.0) * d.dI2, F, y, g);
    add_determinant_hessian(F, d.law.dJ, H);
    // I2 has the gradient F S with dS = -2 dC + 2 dI1 I. The outer products above include the second part, 4 f f'.
    add_product_hessian(F, d.dI2 * S, T(-2.0) * d.dI2, H);
    return H;
  }

  // At rest mu_L = 2 (c10 + c01).
  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    const T& share = m.extra[0];
    return {T(0.5) * m.lame.mu * (T(1.0) - share), T(0.5) * m.lame.mu * share, bulk_modulus(m.lame)};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu / 4 * (s.I1bar - 3 + s.I2bar - 3) + m.K / 2 * (s.J - 1) * (s.J - 1);  // share = 1/2
  }

  static MaterialInfo info() {
    return {
        .name = "mooney_rivlin",
        .formula =
            "c10 (J^(-2/3) I1 - 3) + c01 (J^(-4/3) I2 - 3) + K/2 (J - 1)^2 with "
            "c10 = (1 - share) mu_L/2, c01 = share mu_L/2, K = la_L + 2/3 mu_L, I2 = |cof F|^2",
        .tex =
            {R"tex(\psi = c_{10} (\bar I_1 - 3) + c_{01} (\bar I_2 - 3) + \tfrac{K}{2} (J - 1)^2)tex",
             R"tex(c_{10} = (1 - \mathrm{share})\, \tfrac{\mu}{2}, \quad c_{01} = \mathrm{share}\; \tfrac{\mu}{2})tex",
             R"tex(\bar I_1 = J^{-2/3}\, I_1, \quad K = \lambda + \tfrac23 \mu)tex",
             R"tex(\bar I_2 = J^{-4/3}\, \|\operatorname{cof} F\|^2)tex", R"tex(\psi = \infty \quad (J \le 0))tex"},
        .remarks =
            "+inf for J <= 0, so the initial state must be free of inversion. The only state "
            "without stress is the rest shape, up to rotation, but the energy stays finite "
            "(K/2) as a body shrinks uniformly to a point.",
        .extra = {{.name = "share",
                   .unit = "1",
                   .meaning = "share of c01 in c10 + c01",
                   .fallback = 0.5,
                   .min = 0,
                   .max = 1}},
        .barrier = true};
  }

 private:
  // dpsi/dI2 and d2psi/dI2 dJ in addition to the derivatives with respect to I1 and J.
  template <class T>
  struct Derivatives {
    LawDerivatives<T> law;
    T dI2, dI2J;

    Derivatives(const Mat3<T>& F, const Params<T>& p) {
      const T J = determinant(F), r = T(1.0) / J, s = isochoric_scale(J);
      law = isochoric_derivatives(squared_norm(F), J, p.c10, T(0.0), p.bulk);
      dI2 = p.c01 * s * s;
      dI2J = T(-4.0 / 3.0) * dI2 * r;
      const T slope = dI2J * squared_norm(cofactor(F));
      law.dJ = law.dJ + slope;
      law.dJJ = law.dJJ - T(7.0 / 3.0) * slope * r;
    }
  };
  // dI2/dF = F S, S = 2 (I1 I - C).
  template <class T>
  static Mat3<T> stress_of_I2(const Mat3<T>& F) {
    return T(2.0) * (squared_norm(F) * identity3<T>() - transpose(F) * F);
  }
  template <class T>
  static Mat3<T> gradient_of_I2(const Mat3<T>& F) {
    return F * stress_of_I2(F);
  }
};

}  // namespace aspic
