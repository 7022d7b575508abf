// Linear elasticity: psi = mu |e|^2 + lambda/2 (tr e)^2, e = (F + F')/2 - I.
#pragma once
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"

namespace aspic {

struct Linear : LameParameters {
  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    const Mat3<T> e = strain(F);
    const T tr = trace(e);
    return p.mu * squared_norm(e) + T(0.5) * p.lambda * tr * tr;
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    const Mat3<T> e = strain(F);
    return T(2.0) * p.mu * e + p.lambda * trace(e) * identity3<T>();
  }
  // H(rc, qd) = mu ([r = q][c = d] + [r = d][c = q]) + lambda [r = c][q = d]
  template <class T>
  static Mat9<T> hessian(const Mat3<T>&, const Params<T>& p) {
    Mat9<T> H;
    for (T& h : H.a) h = T(0.0);
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) {
        const int rc = r + 3 * c, cr = c + 3 * r;
        H(rc, rc) = H(rc, rc) + p.mu;
        H(rc, cr) = H(rc, cr) + p.mu;
        H(4 * r, 4 * c) = H(4 * r, 4 * c) + p.lambda;
      }
    return H;
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu * s.strain2 + m.la / 2 * s.strain * s.strain;
  }

  static MaterialInfo info() {
    return {.name = "linear",
            .formula = "mu |e|^2 + la/2 (tr e)^2, e = (F + F')/2 - I, with mu = mu_L, la = la_L",
            .tex = {R"tex(\psi = \mu\, \|\varepsilon\|^2 + \tfrac{\lambda}{2} (\operatorname{tr} \varepsilon)^2)tex",
                    R"tex(\varepsilon = \tfrac12 (F + F^{\mathsf T}) - I)tex"},
            .remarks =
                "Not invariant under rotation: a rotating body swells, so it is for small displacements only. "
                "The energy is convex: one Newton iteration reaches the minimum from anywhere.",
            .objective = false};
  }

 private:
  template <class T>
  static Mat3<T> strain(const Mat3<T>& F) {
    return T(0.5) * (F + transpose(F)) - identity3<T>();
  }
};

}  // namespace aspic
