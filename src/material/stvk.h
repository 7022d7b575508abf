// St. Venant-Kirchhoff model: psi = mu |E|^2 + lambda/2 (tr E)^2, E = (F'F - I) / 2; P = F S, S = 2 mu E + lambda tr E
// I.
#pragma once
#include "material/from_invariants.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"
#include "material/second_piola.h"

namespace aspic {

struct Stvk : LameParameters {
  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    const Mat3<T> E = green_strain(F);
    const T tr = trace(E);
    return p.mu * squared_norm(E) + T(0.5) * p.lambda * tr * tr;
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    return F * stress(green_strain(F), p);
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    Mat9<T> H = identity_plus_outer(T(0.0), p.lambda, F);
    add_product_hessian(F, stress(green_strain(F), p), p.mu, H);
    return H;
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu * s.green2 + m.la / 2 * s.green * s.green;
  }

  static MaterialInfo info() {
    return {.name = "stvk",
            .formula = "mu |E|^2 + la/2 (tr E)^2, E = (F'F - I)/2, with mu = mu_L, la = la_L",
            .tex = {R"tex(\psi = \mu\, \|E\|^2 + \tfrac{\lambda}{2} (\operatorname{tr} E)^2)tex",
                    R"tex(E = \tfrac12 (F^{\mathsf T} F - I))tex"},
            .remarks =
                "Softens in compression: a body shrunk uniformly below 1/sqrt(3) = 0.577 of its "
                "size collapses towards F = 0, and mirror images of the rest shape are free of "
                "stress too. For small strain with large rotation."};
  }

 private:
  template <class T>
  static Mat3<T> green_strain(const Mat3<T>& F) {
    return T(0.5) * (transpose(F) * F - identity3<T>());
  }
  // Computes the second Piola-Kirchhoff stress.
  template <class T>
  static Mat3<T> stress(const Mat3<T>& E, const Params<T>& p) {
    return T(2.0) * p.mu * E + p.lambda * trace(E) * identity3<T>();
  }
};

}  // namespace aspic
