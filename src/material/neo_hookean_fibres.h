// Transversely isotropic solid: neo_hookean_isochoric with a family of fibres, psi = psi_matrix + psi_fibre, where
// psi_fibre is fibre_law.h without dispersion, k1 = fibre_ratio mu, and the direction a = (fibre_x, fibre_y, fibre_z) /
// its length. A direction of length 0 has no fibres.
#pragma once
#include "material/fibre_law.h"
#include "material/neo_hookean_isochoric.h"

namespace aspic {

struct NeoHookeanFibres {
  // Indices in MaterialParameters::extra. The direction has three entries.
  static constexpr int kRatio = 0, kExponent = 1, kDirection = 2;

  template <class T>
  struct Params {
    T mu, bulk;    // of the matrix [Pa]
    T k1;          // [Pa]
    T k2;          // [1]
    T ax, ay, az;  // a
  };

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    return NeoHookeanIsochoric::psi(F, matrix(p)) + FibreLaw::psi(F, fibres(p));
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    return NeoHookeanIsochoric::pk1(F, matrix(p)) + FibreLaw::pk1(F, fibres(p));
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    Mat9<T> H = NeoHookeanIsochoric::hessian(F, matrix(p));
    const Mat9<T> fibre = FibreLaw::hessian(F, fibres(p));
    for (int i = 0; i < 81; ++i) H.a[i] = H.a[i] + fibre.a[i];
    return H;
  }

  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    const auto own = NeoHookeanIsochoric::params(m);
    const T &x = m.extra[kDirection], &y = m.extra[kDirection + 1], &z = m.extra[kDirection + 2];
    const T scale = T(1.0) / sqrt(x * x + y * y + z * z + T(kTiny));
    return {own.mu, own.bulk, m.extra[kRatio] * m.lame.mu, m.extra[kExponent], scale * x, scale * y, scale * z};
  }

  // Without fibres, which is the default.
  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return NeoHookeanIsochoric::reference_energy(s, m);
  }

  static MaterialInfo info() {
    const auto component = [](const char* name) {
      return ExtraParameter{.name = name,
                            .unit = "1",
                            .meaning = "component of the direction of the fibres; its length is irrelevant",
                            .fallback = 0,
                            .min = -1,
                            .max = 1};
    };
    return {
        .name = "neo_hookean_fibres",
        .formula =
            "neo_hookean_isochoric + k1/(2 k2) (exp(k2 E^2) - 1) for E = |F a|^2 - 1 > 0 with k1 = fibre_ratio mu_L, "
            "k2 = fibre_exponent, a along (fibre_x, fibre_y, fibre_z)",
        .tex =
            {R"tex(\psi = \tfrac{\mu}{2} (\bar I_1 - 3) + \tfrac{K}{2} (J - 1)^2 + \frac{k_1}{2 k_2} (e^{k_2 E^2} - 1))tex",
             R"tex(E = \max(\|F a\|^2 - 1,\, 0), \quad k_1 = r \mu)tex",
             R"tex(\bar I_1 = J^{-2/3}\, I_1, \quad K = \lambda + \tfrac23 \mu)tex",
             R"tex(\psi = \infty \quad (J \le 0))tex"},
        .remarks =
            "One family of fibres along a, which act in tension only and straighten over E = 0.03. A direction of "
            "length 0 has no fibres. [Gasser 2006] without dispersion. +inf for J <= 0.",
        .extra = {{.name = "fibre_ratio",
                   .unit = "1",
                   .meaning = "stiffness of the fibres relative to the shear modulus",
                   .fallback = 0,
                   .min = 0,
                   .max = 1000},
                  {.name = "fibre_exponent",
                   .unit = "1",
                   .meaning = "exponent of the fibres",
                   .fallback = 1,
                   .min = 0.01,
                   .max = 100},
                  component("fibre_x"),
                  component("fibre_y"),
                  component("fibre_z")},
        .barrier = true};
  }

 private:
  static constexpr double kTiny = 1e-300;

  template <class T>
  static NeoHookeanIsochoric::Params<T> matrix(const Params<T>& p) {
    return {p.mu, p.bulk};
  }
  template <class T>
  static FibreLaw::Params<T> fibres(const Params<T>& p) {
    return {p.k1, p.k2, T(0.0), p.ax, p.ay, p.az};
  }
};

}  // namespace aspic
