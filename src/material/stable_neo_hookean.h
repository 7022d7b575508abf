// Stable neo-Hookean model of [Smith 2018]. The logarithm removes the attraction to F = 0 of neo_hookean.
//   psi = mu/2 (I1 - 3) + lambda/2 (J - alpha)^2 - mu/2 ln(I1 + 1) + constant,   alpha = 1 + 3 mu / (4 lambda)
// The implementation is expanded around J = 1 to avoid a division by lambda.
#pragma once
#include "material/from_invariants.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"

namespace aspic {

struct StableNeoHookeanLaw : LameParameters {
  template <class T>
  static T energy(const T& I1, const T& J, const Params<T>& p) {
    const T dJ = J - T(1.0);
    return T(0.5) * p.mu * (I1 - T(3.0) - log(T(0.25) * (I1 + T(1.0)))) +
           (T(0.5) * p.lambda * dJ - T(0.75) * p.mu) * dJ;
  }
  template <class T>
  static LawDerivatives<T> derivatives(const T& I1, const T& J, const Params<T>& p) {
    const T r = T(1.0) / (I1 + T(1.0)), half_mu = T(0.5) * p.mu;
    return {.dI = half_mu - half_mu * r,
            .dJ = p.lambda * (J - T(1.0)) - T(0.75) * p.mu,
            .dII = half_mu * r * r,
            .dIJ = T(0.0),
            .dJJ = p.lambda};
  }

  // At rest: mu_L = 3/4 mu, lambda_L = lambda - 5/8 mu.
  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    return {T(4.0 / 3.0) * m.lame.mu, m.lame.lambda + T(5.0 / 6.0) * m.lame.mu};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    const long double mu = 4 * m.mu / 3, a = m.la + 5 * m.mu / 6, alpha = 1 + 3 * mu / (4 * a);
    return mu / 2 * (s.I1 - 3) + a / 2 * (s.J - alpha) * (s.J - alpha) - mu / 2 * std::log(s.I1 + 1);
  }

  static MaterialInfo info() {
    return {
        .name = "stable_neo_hookean",
        .formula =
            "mu/2 (I1 - 3) + la/2 (J - alpha)^2 - mu/2 ln((I1 + 1)/4) with mu = 4/3 mu_L, "
            "la = la_L + 5/6 mu_L, alpha = 1 + 3 mu/(4 la), up to a constant",
        .tex =
            {R"tex(\begin{gathered} \psi = \tfrac{2 \mu}{3} \left(I_1 - 3 - \ln \tfrac{I_1 + 1}{4}\right) \\ \quad - \mu (J - 1) + \tfrac12 \left(\lambda + \tfrac56 \mu\right) (J - 1)^2 \end{gathered})tex"},
        .remarks =
            "Defined for inverted elements. The only states without stress are the rest "
            "shape, up to rotation, and F = 0: a saddle whose Hessian is zero, which a body "
            "in one point leaves only after a perturbation. [Smith 2018]"};
  }
};

using StableNeoHookean = FromInvariants<StableNeoHookeanLaw>;

}  // namespace aspic
