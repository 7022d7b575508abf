// Corotated solid with the exact volume term ("fixed corotated"): psi = mu |F - R|^2 + lambda/2 (J - 1)^2,
// R the rotation closest to F [Stomakhin 2012].
#pragma once
#include "material/from_invariants.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"
#include "material/rotation_distance.h"

namespace aspic {

struct Corotated : LameParameters {
  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    const T dJ = determinant(F) - T(1.0);
    return p.mu * squared_rotation_distance(F) + T(0.5) * p.lambda * dJ * dJ;
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    const T tension = p.lambda * (determinant(F) - T(1.0));
    return T(2.0) * p.mu * (F - closest_rotation(F)) + tension * cofactor(F);
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    const T tension = p.lambda * (determinant(F) - T(1.0));
    Mat9<T> H = law_hessian(F, LawDerivativesLinearInI1<T>{p.mu, tension, p.lambda});
    add_rotation_gradient(svd3(F), T(-2.0) * p.mu, kMinStretchSum, H);
    return H;
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu * s.strain2 + m.la / 2 * (s.J - 1) * (s.J - 1);
  }

  static MaterialInfo info() {
    return {.name = "corotated",
            .formula = "mu |F - R|^2 + la/2 (J - 1)^2, R the rotation closest to F, with mu = mu_L, la = la_L",
            .tex = {R"tex(\psi = \mu\, \|F - R\|^2 + \tfrac{\lambda}{2} (J - 1)^2)tex",
                    R"tex(R = \operatorname{argmin}_{Q \in SO(3)} \|F - Q\|)tex"},
            .remarks =
                "Defined for inverted elements. The only states without stress are the rest "
                "shape, up to rotation. R, and so the stress, jumps where two signed singular "
                "values sum to zero, F = 0 among them. [Stomakhin 2012]"};
  }
};

}  // namespace aspic
