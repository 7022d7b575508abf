// Neo-Hookean model with isochoric split: psi = mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2; +inf for J <= 0.
#pragma once
#include "material/isochoric.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"

namespace aspic {

struct NeoHookeanIsochoricLaw {
  template <class T>
  struct Params {
    T mu, bulk;  // [Pa]
  };

  template <class T>
  static T energy(const T& I1, const T& J, const Params<T>& p) {
    return isochoric_energy(J, T(0.5) * p.mu * (isochoric_scale(J) * I1 - T(3.0)), p.bulk);
  }
  template <class T>
  static LawDerivatives<T> derivatives(const T& I1, const T& J, const Params<T>& p) {
    return isochoric_derivatives(I1, J, T(0.5) * p.mu, T(0.0), p.bulk);
  }

  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    return {m.lame.mu, bulk_modulus(m.lame)};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu / 2 * (s.I1bar - 3) + m.K / 2 * (s.J - 1) * (s.J - 1);
  }

  static MaterialInfo info() {
    return {.name = "neo_hookean_isochoric",
            .formula = "mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2 with mu = mu_L, K = la_L + 2/3 mu_L",
            .tex = {R"tex(\psi = \tfrac{\mu}{2} (\bar I_1 - 3) + \tfrac{K}{2} (J - 1)^2)tex",
                    R"tex(\bar I_1 = J^{-2/3}\, I_1, \quad K = \lambda + \tfrac23 \mu)tex",
                    R"tex(\psi = \infty \quad (J \le 0))tex"},
            .remarks =
                "+inf for J <= 0, so the initial state must be free of inversion. The only state "
                "without stress is the rest shape, up to rotation, but the energy stays finite "
                "(K/2) as a body shrinks uniformly to a point: no barrier in that direction.",
            .barrier = true};
  }
};

using NeoHookeanIsochoric = FromInvariants<NeoHookeanIsochoricLaw>;

}  // namespace aspic
