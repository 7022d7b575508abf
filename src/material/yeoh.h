// Yeoh solid: psi = mu/2 (x + b2 x^2 + b3 x^3) + K/2 (J - 1)^2, x = J^(-2/3) I1 - 3; +inf for J <= 0.
#pragma once
#include "material/isochoric.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"

namespace aspic {

struct YeohLaw {
  template <class T>
  struct Params {
    T mu, bulk;  // [Pa]
    T b2, b3;    // [1]
  };

  template <class T>
  static T energy(const T& I1, const T& J, const Params<T>& p) {
    const T x = isochoric_scale(J) * I1 - T(3.0);
    return isochoric_energy(J, T(0.5) * p.mu * x * (T(1.0) + x * (p.b2 + x * p.b3)), p.bulk);
  }
  template <class T>
  static LawDerivatives<T> derivatives(const T& I1, const T& J, const Params<T>& p) {
    const T x = isochoric_scale(J) * I1 - T(3.0), half = T(0.5) * p.mu;
    const T slope = half * (T(1.0) + x * (T(2.0) * p.b2 + T(3.0) * x * p.b3));
    return isochoric_derivatives(I1, J, slope, half * (T(2.0) * p.b2 + T(6.0) * x * p.b3), p.bulk);
  }

  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    return {m.lame.mu, bulk_modulus(m.lame), m.extra[0], m.extra[1]};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    const long double x = s.I1bar - 3;  // b2 = 0.1, b3 = 0.01
    return m.mu / 2 * (x + x * x / 10 + x * x * x / 100) + m.K / 2 * (s.J - 1) * (s.J - 1);
  }

  static MaterialInfo info() {
    return {
        .name = "yeoh",
        .formula =
            "mu/2 (x + b2 x^2 + b3 x^3) + K/2 (J - 1)^2, x = J^(-2/3) I1 - 3, with mu = mu_L, "
            "K = la_L + 2/3 mu_L",
        .tex = {R"tex(\psi = \tfrac{\mu}{2} (x + b_2 x^2 + b_3 x^3) + \tfrac{K}{2} (J - 1)^2)tex",
                R"tex(x = \bar I_1 - 3, \quad \bar I_1 = J^{-2/3}\, I_1, \quad K = \lambda + \tfrac23 \mu)tex",
                R"tex(\psi = \infty \quad (J \le 0))tex"},
        .remarks =
            "+inf for J <= 0, so the initial state must be free of inversion. In terms of the constants "
            "C10, C20, C30 of other programs, b2 = C20/C10 and b3 = C30/C10. Where b2 < -sqrt(3 b3), "
            "stress falls with the stretch in a part of the range. [Yeoh 1993]",
        .extra = {{.name = "b2", .unit = "1", .meaning = "coefficient of x^2", .fallback = 0.1, .min = -10, .max = 1e3},
                  {.name = "b3", .unit = "1", .meaning = "coefficient of x^3", .fallback = 0.01, .min = 0, .max = 1e3}},
        .barrier = true};
  }
};

using Yeoh = FromInvariants<YeohLaw>;

}  // namespace aspic
