// Neo-Hookean model with barrier and quadratic volume term: psi = mu/2 (I1 - 3) - mu ln J + lambda/2 (J - 1)^2; +inf
// for J <= 0.
#pragma once
#include "material/barrier.h"
#include "material/from_invariants.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"

namespace aspic {

struct NeoHookeanLogJ2Law : LameParameters {
  template <class T>
  static T energy(const T& I1, const T& J, const Params<T>& p) {
    const T dJ = J - T(1.0);
    return infinite_unless_positive(J, T(0.5) * p.mu * (I1 - T(3.0)) - p.mu * log(J) + T(0.5) * p.lambda * dJ * dJ);
  }
  template <class T>
  static LawDerivativesLinearInI1<T> derivatives(const T&, const T& J, const Params<T>& p) {
    const T r = T(1.0) / J;
    return {T(0.5) * p.mu, p.lambda * (J - T(1.0)) - p.mu * r, p.lambda + p.mu * r * r};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu / 2 * (s.I1 - 3) - m.mu * std::log(s.J) + m.la / 2 * (s.J - 1) * (s.J - 1);
  }

  static MaterialInfo info() {
    return {.name = "neo_hookean_log_j2",
            .formula = "mu/2 (I1 - 3) - mu ln J + la/2 (J - 1)^2 with mu = mu_L, la = la_L",
            .tex = {R"tex(\psi = \tfrac{\mu}{2} (I_1 - 3) - \mu \ln J + \tfrac{\lambda}{2} (J - 1)^2)tex",
                    R"tex(\psi = \infty \quad (J \le 0))tex"},
            .remarks =
                "Barrier: +inf for J <= 0, so the initial state must be free of inversion. Convex in J, and the only "
                "state without stress is the rest shape, up to rotation (la >= 0).",
            .barrier = true};
  }
};

using NeoHookeanLogJ2 = FromInvariants<NeoHookeanLogJ2Law>;

}  // namespace aspic
