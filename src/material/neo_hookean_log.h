// Neo-Hookean model with logarithmic volume term: psi = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2; +inf for J <= 0.
#pragma once
#include "material/barrier.h"
#include "material/from_invariants.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"

namespace aspic {

struct NeoHookeanLogLaw : LameParameters {
  template <class T>
  static T energy(const T& I1, const T& J, const Params<T>& p) {
    const T L = log(J);
    return infinite_unless_positive(J, T(0.5) * p.mu * (I1 - T(3.0)) + (T(0.5) * p.lambda * L - p.mu) * L);
  }
  template <class T>
  static LawDerivativesLinearInI1<T> derivatives(const T&, const T& J, const Params<T>& p) {
    const T inverse_J = T(1.0) / J;
    const T tension = p.lambda * log(J) - p.mu;  // J dpsi/dJ
    return {T(0.5) * p.mu, tension * inverse_J, (p.lambda - tension) * inverse_J * inverse_J};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu / 2 * (s.I1 - 3) - m.mu * std::log(s.J) + m.la / 2 * std::log(s.J) * std::log(s.J);
  }

  static MaterialInfo info() {
    return {.name = "neo_hookean_log",
            .formula = "mu/2 (I1 - 3) - mu ln J + la/2 (ln J)^2 with mu = mu_L, la = la_L",
            .tex = {R"tex(\psi = \tfrac{\mu}{2} (I_1 - 3) - \mu \ln J + \tfrac{\lambda}{2} (\ln J)^2)tex",
                    R"tex(\psi = \infty \quad (J \le 0))tex"},
            .remarks =
                "Barrier: +inf for J <= 0, so the initial state must be free of inversion. For nu >= 0 the only state "
                "without "
                "stress is the rest shape, up to rotation; for nu < 0 the volume term decreases towards J = 0 faster "
                "than the "
                "barrier grows. "
                "The volume term softens beyond J = e.",
            .barrier = true};
  }
};

using NeoHookeanLog = FromInvariants<NeoHookeanLogLaw>;

}  // namespace aspic
