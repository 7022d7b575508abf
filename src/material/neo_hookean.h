// Inversion-tolerant neo-Hookean model: psi = mu/2 (I1 - 3) - mu (J - 1) + lambda/2 (J - 1)^2. Up to a constant, this
// is mu/2 (I1 - 3) + lambda/2 (J - alpha)^2, alpha = 1 + mu/lambda [Smith 2018].
#pragma once
#include "material/from_invariants.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"

namespace aspic {

struct NeoHookeanLaw : LameParameters {
  template <class T>
  static T energy(const T& I1, const T& J, const Params<T>& p) {
    const T dJ = J - T(1.0);
    return T(0.5) * p.mu * (I1 - T(3.0)) + (T(0.5) * p.lambda * dJ - p.mu) * dJ;
  }
  template <class T>
  static LawDerivativesLinearInI1<T> derivatives(const T&, const T& J, const Params<T>& p) {
    return {T(0.5) * p.mu, p.lambda * (J - T(1.0)) - p.mu, p.lambda};
  }

  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    return {m.lame.mu, m.lame.lambda + m.lame.mu};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu / 2 * (s.I1 - 3) - m.mu * (s.J - 1) + (m.la + m.mu) / 2 * (s.J - 1) * (s.J - 1);
  }

  static MaterialInfo info() {
    return {.name = "neo_hookean",
            .formula = "mu/2 (I1 - 3) - mu (J - 1) + la/2 (J - 1)^2 with mu = mu_L, la = la_L + mu_L",
            .tex = {R"tex(\psi = \tfrac{\mu}{2} (I_1 - 3) - \mu (J - 1) + \tfrac{\lambda + \mu}{2} (J - 1)^2)tex"},
            .remarks =
                "Defined for inverted elements. Has a second stable state, collapsed: a body shrunk uniformly "
                "below 0.291 of its size (nu = 0.3; 0.091 at nu = 0.45) does not recover. [Smith 2018]"};
  }
};

using NeoHookean = FromInvariants<NeoHookeanLaw>;

}  // namespace aspic
