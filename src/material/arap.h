// As-rigid-as-possible model: psi = mu |F - R|^2, where R is the rotation closest to F. It has no volume term.
#pragma once
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"
#include "material/rotation_distance.h"

namespace aspic {

struct Arap {
  template <class T>
  struct Params {
    T mu;  // [Pa]
  };

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    return p.mu * squared_rotation_distance(F);
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    return T(2.0) * p.mu * (F - closest_rotation(F));
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    const T two_mu = T(2.0) * p.mu;
    Mat9<T> H;
    for (int i = 0; i < 81; ++i) H.a[i] = i % 10 == 0 ? two_mu : T(0.0);
    add_rotation_gradient(svd3(F), -two_mu, kMinStretchSum, H);
    return H;
  }

  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    return {m.lame.mu};
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu * s.strain2;
  }

  static MaterialInfo info() {
    return {.name = "arap",
            .formula = "mu |F - R|^2, R the rotation closest to F, with mu = mu_L",
            .tex = {R"tex(\psi = \mu\, \|F - R\|^2)tex", R"tex(R = \operatorname{argmin}_{Q \in SO(3)} \|F - Q\|)tex"},
            .remarks =
                "Reproduces the shear modulus only: la_L is ignored, so at small strain nu = 0 "
                "and E = 2 mu_L. The only states without stress are the rest shape, up to "
                "rotation; the stress jumps where two signed singular values sum to zero, F = 0 "
                "among them."};
  }
};

}  // namespace aspic
