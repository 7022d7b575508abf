// Gent solid of chains with a limited length: psi = -mu limit/2 ln(1 - (I1bar - 3)/limit) + K/2 (J - 1)^2, I1bar =
// J^(-2/3) I1; +inf for J <= 0 and for I1bar - 3 >= limit.
#pragma once
#include "material/isochoric.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"

namespace aspic {

struct GentLaw {
  template <class T>
  struct Params {
    T mu, bulk;  // [Pa]
    T limit;     // of I1bar - 3 [1]
  };

  template <class T>
  static T energy(const T& I1, const T& J, const Params<T>& p) {
    const T left = T(1.0) - (isochoric_scale(J) * I1 - T(3.0)) / p.limit;
    const T W = infinite_unless_positive(left, T(-0.5) * p.mu * p.limit * log(left));
    return isochoric_energy(J, W, p.bulk);
  }
  template <class T>
  static LawDerivatives<T> derivatives(const T& I1, const T& J, const Params<T>& p) {
    const T left = T(1.0) - (isochoric_scale(J) * I1 - T(3.0)) / p.limit;
    const T slope = infinite_unless_positive(left, T(0.5) * p.mu / left);
    return isochoric_derivatives(I1, J, slope, slope / (left * p.limit), p.bulk);
  }

  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    return {m.lame.mu, bulk_modulus(m.lame), m.extra[0]};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return -m.mu * 50 * std::log1p(-(s.I1bar - 3) / 100) + m.K / 2 * (s.J - 1) * (s.J - 1);  // limit = 100
  }

  static MaterialInfo info() {
    return {.name = "gent",
            .formula =
                "-mu limit/2 ln(1 - (J^(-2/3) I1 - 3)/limit) + K/2 (J - 1)^2 with mu = mu_L, "
                "K = la_L + 2/3 mu_L",
            .tex = {R"tex(\psi = -\tfrac{\mu\, I_m}{2} \ln\left(1 - \tfrac{\bar I_1 - 3}{I_m}\right)
                          + \tfrac{K}{2} (J - 1)^2)tex",
                    R"tex(I_m = \mathrm{limit}, \quad \bar I_1 = J^{-2/3}\, I_1, \quad K = \lambda + \tfrac23 \mu)tex",
                    R"tex(\psi = \infty \quad (J \le 0 \text{ or } \bar I_1 - 3 \ge I_m))tex"},
            .remarks =
                "+inf for J <= 0 and beyond the limit, so the initial state must be free of inversion and within "
                "the limit. The only state without stress is the rest shape, up to rotation. [Gent 1996]",
            .extra = {{.name = "limit",
                       .unit = "1",
                       .meaning = "largest J^(-2/3) I1 - 3",
                       .fallback = 100,
                       .min = 1e-2,
                       .max = 1e6}},
            .barrier = true};
  }
};

using Gent = FromInvariants<GentLaw>;

}  // namespace aspic
