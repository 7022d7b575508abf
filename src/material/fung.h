// Isotropic Fung-type exponential model: psi = mu/(2b) (exp(b (I1bar - 3)) - 1) + K/2 (J - 1)^2, I1bar = J^(-2/3) I1;
// +inf for J <= 0. b -> 0 yields neo_hookean_isochoric.
#pragma once
#include "material/isochoric.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"

namespace aspic {

struct FungLaw {
  template <class T>
  struct Params {
    T mu, bulk;  // [Pa]
    T b;         // stiffening [1]
  };

  template <class T>
  static T energy(const T& I1, const T& J, const Params<T>& p) {
    return isochoric_energy(J, T(0.5) * p.mu / p.b * (stiffening(I1, J, p) - T(1.0)), p.bulk);
  }
  template <class T>
  static LawDerivatives<T> derivatives(const T& I1, const T& J, const Params<T>& p) {
    const T slope = T(0.5) * p.mu * stiffening(I1, J, p);
    return isochoric_derivatives(I1, J, slope, p.b * slope, p.bulk);
  }

  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    return {m.lame.mu, bulk_modulus(m.lame), m.extra[0]};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu / 2 * (std::exp(s.I1bar - 3) - 1) + m.K / 2 * (s.J - 1) * (s.J - 1);  // b = 1
  }

  static MaterialInfo info() {
    return {.name = "fung",
            .formula = "mu/(2b) (exp(b (J^(-2/3) I1 - 3)) - 1) + K/2 (J - 1)^2 with mu = mu_L, K = la_L + 2/3 mu_L",
            .tex = {R"tex(\psi = \tfrac{\mu}{2b} \left(e^{b (\bar I_1 - 3)} - 1\right) + \tfrac{K}{2} (J - 1)^2)tex",
                    R"tex(\bar I_1 = J^{-2/3}\, I_1, \quad K = \lambda + \tfrac23 \mu)tex",
                    R"tex(\psi = \infty \quad (J \le 0))tex"},
            .remarks =
                "+inf for J <= 0 and where the exponential overflows. The only state without "
                "stress is the rest shape, up to rotation; the stiffness grows like exp(b I1bar),"
                " so steps from large strain are many and short.",
            .extra = {{.name = "b",
                       .unit = "1",
                       .meaning = "exponential stiffening of the shape-changing part",
                       .fallback = 1,
                       .min = 1e-3,
                       .max = 1e3}},
            .barrier = true};
  }

 private:
  template <class T>
  static T stiffening(const T& I1, const T& J, const Params<T>& p) {
    return exp(p.b * (isochoric_scale(J) * I1 - T(3.0)));
  }
};

using Fung = FromInvariants<FungLaw>;

}  // namespace aspic
