// Data-driven solid, polyconvex by construction; +inf for J <= 0:
//   psi = mu (1 - share) [(1 - softening) (I1bar - 3)/2 + softening S(|F|, J^(1/3))] + mu/2 g1(I1bar - 3)
//       + mu share S(|cof F|, J^(2/3)) + mu/(3 sqrt 3) g2(y) + K/2 (J - 1)^2
//   S(x, s) = sqrt 3 x - 3 s,   y = I2bar^(3/2) - 3 sqrt 3
// g1 and g2 are convex splines (convex_spline.h). Each of their coefficients, the growths, is the increase of the slope
// of a term near one knot, relative to its slope at rest if it contributed the whole shear modulus.
//
// Polyconvex [Ball 1977]: |F|^p / J^q is convex in (F, J), J > 0, if p >= q + 1 >= 1. So are I1bar = |F|^2 / J^(2/3)
// and, in (cof F, J), I2bar^(3/2) = |cof F|^3 / J^2, but not I2bar itself [Hartmann 2003]. |F|, |cof F|, -J^(1/3) and
// -J^(2/3) are convex. A convex nondecreasing function of a convex function is convex. With growths >= 0 and 0 <=
// share, softening <= 1, psi is a sum of such terms. S grows least: rubber softens before it stiffens.
//
// At rest, g1, g2 and their slopes are 0, and S equals (I1bar - 3)/2 or (I2bar - 3)/2 to second order and 0 for every
// uniform scaling. Hence the small-strain moduli are exact for any coefficients. psi has continuous second derivatives.
#pragma once
#include <numbers>
#include <string>

#include "material/from_two_invariants.h"
#include "material/material.h"
#include "material/reference.h"
#include "material/registry.h"

namespace aspic {

struct SplineLaw {
  static constexpr int kGrowths = 8, kAreaGrowths = 3;
  static constexpr ConvexSpline<kGrowths> kStretchSpline{{0, 0.03, 0.1, 0.3, 1, 3, 10, 30, 60, 100}};  // over I1bar - 3
  static constexpr ConvexSpline<kAreaGrowths> kAreaSpline{{0, 1, 10, 100, 1000}};                      // over y

  template <class T>
  struct Params {
    T straight, soft, area, bulk;                   // weights of I1bar - 3 and of both S, and K [Pa]
    T growth[kGrowths], area_growth[kAreaGrowths];  // coefficients of g1 and g2 [Pa]
  };

  template <class T>
  static Curve<T> W1(const T& I1bar, const Params<T>& p) {
    Curve<T> g = kStretchSpline(I1bar - T(3.0), p.growth);
    g.value = g.value + p.straight * (I1bar - T(3.0));
    g.slope = g.slope + p.straight;
    return g;
  }
  template <class T>
  static Curve<T> W2(const T& I2bar, const Params<T>& p) {
    const T root = sqrt(I2bar), dy = T(1.5) * root, ddy = T(0.75) / root;
    const Curve<T> g = kAreaSpline(I2bar * root - T(3.0 * std::numbers::sqrt3), p.area_growth);
    return {g.value, g.slope * dy, g.curvature * dy * dy + g.slope * ddy};
  }
  template <class T>
  static Curve<T> U1(const T& I1, const Params<T>& p) {
    return square_root(I1, p.soft);
  }
  template <class T>
  static Curve<T> U2(const T& I2, const Params<T>& p) {
    return square_root(I2, p.area);
  }
  template <class T>
  static Curve<T> V(const T& J, const Params<T>& p) {
    const T dJ = J - T(1.0), root = cbrt(J), r = T(1.0) / J;
    const T a = p.soft * root, b = p.area * root * root;  // factors in -3 a - 3 b
    return {T(0.5) * p.bulk * dJ * dJ - T(3.0) * (a + b), p.bulk * dJ - (a + T(2.0) * b) * r,
            p.bulk + T(2.0 / 3.0) * (a + b) * r * r};
  }

  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    const T share = m.extra[0], softening = m.extra[1], one = T(1.0), mu = m.lame.mu;
    Params<T> p{.straight = T(0.5) * mu * (one - share) * (one - softening),
                .soft = mu * (one - share) * softening,
                .area = mu * share,
                .bulk = bulk_modulus(m.lame),
                .growth = {},
                .area_growth = {}};
    for (int i = 0; i < kGrowths; ++i) p.growth[i] = T(0.5) * mu * m.extra[2 + i];
    for (int i = 0; i < kAreaGrowths; ++i)
      p.area_growth[i] = T(1 / (3 * std::numbers::sqrt3)) * mu * m.extra[2 + kGrowths + i];
    return p;
  }

  static long double reference_energy(const PrincipalStretches& s, const ReferenceModuli& m) {
    return m.mu / 2 * (s.I1bar - 3) + m.K / 2 * (s.J - 1) * (s.J - 1);  // no growths
  }

  static MaterialInfo info() {
    return {
        .name = "spline",
        .formula =
            "mu (1 - share) ((1 - softening) (I1bar - 3)/2 + softening (sqrt 3 |F| - 3 J^(1/3))) + mu share "
            "(sqrt 3 |cof F| - 3 J^(2/3)) + mu/2 g1(I1bar - 3) + mu/(3 sqrt 3) g2(I2bar^(3/2) - 3 sqrt 3) + "
            "K/2 (J - 1)^2 with convex splines g1 and g2, mu = mu_L, K = la_L + 2/3 mu_L",
        .tex =
            {R"tex(\psi = W_1 + W_2 + \tfrac{K}{2} (J - 1)^2)tex",
             R"tex(\begin{gathered} W_1 = \tfrac{\mu}{2} (1 - a)(1 - s) (\bar I_1 - 3) + \tfrac{\mu}{2}\, g_1(\bar I_1 - 3) \\ \quad + \mu (1 - a)\, s\, (\sqrt3\, \|F\| - 3 J^{1/3}) \end{gathered})tex",
             R"tex(\begin{gathered} W_2 = \mu a\, (\sqrt3\, \|\operatorname{cof} F\| - 3 J^{2/3}) \\ \quad + \tfrac{\mu}{3 \sqrt3}\, g_2(\bar I_2^{3/2} - 3 \sqrt3) \end{gathered})tex",
             R"tex(a = \mathrm{share}, \quad s = \mathrm{softening})tex",
             R"tex(\bar I_1 = J^{-2/3}\, I_1, \quad K = \lambda + \tfrac23 \mu)tex",
             R"tex(\bar I_2 = J^{-4/3}\, \|\operatorname{cof} F\|^2)tex", R"tex(\psi = \infty \quad (J \le 0))tex"},
        .remarks =
            "Polyconvex for any coefficients; without growth, share and softening it is "
            "neo_hookean_isochoric. +inf for J <= 0, so the initial state must be free of inversion. The only state "
            "without stress is the rest shape, up to rotation, but the energy stays finite (K/2) as a body "
            "shrinks uniformly to a point. [Hartmann 2003]",
        .extra = coefficients(),
        .barrier = true};
  }

 private:
  // Curve c sqrt 3 sqrt(I); at I = 3, where V compensates it, 3 c.
  template <class T>
  static Curve<T> square_root(const T& I, const T& c) {
    const T value = T(std::numbers::sqrt3) * c * sqrt(I), slope = T(0.5) * value / I;
    return {value, slope, T(-0.5) * slope / I};
  }

  static std::vector<ExtraParameter> coefficients() {
    std::vector<ExtraParameter> list = {{.name = "share",
                                         .unit = "1",
                                         .meaning = "share of the shear modulus that |cof F| carries",
                                         .fallback = 0,
                                         .min = 0,
                                         .max = 1},
                                        {.name = "softening",
                                         .unit = "1",
                                         .meaning = "share of |F| in the rest, which softens with stretch",
                                         .fallback = 0,
                                         .min = 0,
                                         .max = 1}};
    add_growths("growth_", "I1bar - 3", kStretchSpline, list);
    add_growths("area_growth_", "I2bar^(3/2) - 3 sqrt 3", kAreaSpline, list);
    return list;
  }
  template <std::size_t N>
  static void add_growths(const std::string& name, const std::string& of, const ConvexSpline<N>& spline,
                          std::vector<ExtraParameter>& list) {
    const std::string meaning = "growth of the slope in " + of + " about ";
    for (std::size_t i = 1; i <= N; ++i) {
      std::string knot = std::to_string(spline.knots[i]);
      knot.erase(knot.find_last_not_of('0') + 1);
      if (knot.back() == '.') knot.pop_back();
      list.push_back({.name = name + std::to_string(i),
                      .unit = "1",
                      .meaning = meaning + knot,
                      .fallback = 0,
                      .min = 0,
                      .max = 1e3});
    }
  }
};

using Spline = FromTwoInvariants<SplineLaw>;

}  // namespace aspic
