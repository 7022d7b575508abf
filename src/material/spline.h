// Data-driven solid, polyconvex by construction: psi = W1(I1bar) + W2(I2bar) + K/2 (J - 1)^2; +inf for J <= 0,
//   W1 = mu/2 (1 - share) [(1 - softening) (I1bar - 3) + softening S(I1bar)] + mu/2 g1(I1bar - 3)
//   W2 = mu/(3 sqrt 3) [share y + g2(y)],   y = I2bar^(3/2) - 3 sqrt 3,   S = 4/3 (3^(1/4) I1bar^(3/4) - 3)
// g1 and g2 are convex splines (convex_spline.h) whose coefficients, the growths, say by how much the slope of a term
// grows about each knot, relative to what it would be at rest if it carried the whole shear modulus.
//
// Polyconvex [Ball 1977]: |F|^p / J^q is convex in (F, J), J > 0, if p >= q + 1 >= 1, therefore so are
// I1bar^(3/4) = |F|^(3/2) / J^(1/2) and I1bar, and I2bar^(3/2) = |cof F|^3 / J^2 in (cof F, J) (I2bar itself is not)
// [Hartmann 2003]. A convex nondecreasing function of a convex function is convex, and with growths >= 0 and
// 0 <= share, softening <= 1 all of psi is a sum of such and of a convex function of J. W1 is the reason for S: it is
// the term of least growth in I1bar that is still polyconvex, and rubber softens before it stiffens.
//
// At rest, g1, g2 and their slopes are 0 and S = I1bar - 3 to second order, so the small-strain moduli are exact
// whatever the coefficients. psi has continuous second derivatives.
#pragma once
#include <numbers>
#include <string>

#include "material/from_isochoric_invariants.h"
#include "material/material.h"
#include "material/registry.h"

namespace aspic {

struct SplineLaw {
  static constexpr ConvexSpline<7> kStretchSpline{{0, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100}};  // over I1bar - 3
  static constexpr ConvexSpline<3> kAreaSpline{{0, 1, 10, 100, 1000}};                      // over y

  template <class T>
  struct Params {
    T straight, soft, area, bulk;  // weights of I1bar - 3, S and y, and K [Pa]
    T growth[7], area_growth[3];   // of g1 and g2 [Pa]
  };

  template <class T>
  static Curve<T> W1(const T& I1bar, const Params<T>& p) {
    const Curve<T> g = kStretchSpline(I1bar - T(3.0), p.growth);
    const T slope = sqrt(sqrt(T(3.0) / I1bar));  // S'
    return {p.straight * (I1bar - T(3.0)) + p.soft * T(4.0 / 3.0) * (I1bar * slope - T(3.0)) + g.value,
            p.straight + p.soft * slope + g.slope, g.curvature - T(0.25) * p.soft * slope / I1bar};
  }
  template <class T>
  static Curve<T> W2(const T& I2bar, const Params<T>& p) {
    const T root = sqrt(I2bar), y = I2bar * root - T(3.0 * std::numbers::sqrt3);
    const Curve<T> g = kAreaSpline(y, p.area_growth);
    const T dy = T(1.5) * root, ddy = T(0.75) / root, slope = p.area + g.slope;
    return {p.area * y + g.value, slope * dy, g.curvature * dy * dy + slope * ddy};
  }

  static Params<double> params(const MaterialParameters& m) {
    const double share = m.extra[0], softening = m.extra[1];
    const double stretch = 0.5 * m.lame.mu, area = m.lame.mu / (3 * std::numbers::sqrt3);
    Params<double> p{stretch * (1 - share) * (1 - softening),
                     stretch * (1 - share) * softening,
                     area * share,
                     bulk_modulus(m.lame),
                     {},
                     {}};
    for (int i = 0; i < 7; ++i) p.growth[i] = stretch * m.extra[2 + i];
    for (int i = 0; i < 3; ++i) p.area_growth[i] = area * m.extra[9 + i];
    return p;
  }

  static MaterialInfo info() {
    return {.name = "spline",
            .formula =
                "mu/2 ((1 - share) ((1 - softening) (I1bar - 3) + softening S) + g1(I1bar - 3)) + mu/(3 sqrt 3) "
                "(share y + g2(y)) + K/2 (J - 1)^2 with S = 4/3 (3^(1/4) I1bar^(3/4) - 3), "
                "y = I2bar^(3/2) - 3 sqrt 3, convex splines g1 and g2, mu = mu_L, K = la_L + 2/3 mu_L",
            .remarks =
                "Polyconvex whatever the coefficients; without growth, share and softening it is "
                "neo_hookean_isochoric. +inf for J <= 0, so every start must be free of inversion. The only state "
                "without stress is the rest shape, up to rotation, but the energy stays finite (K/2) as a body "
                "shrinks uniformly to a point. [Hartmann 2003]",
            .extra = coefficients(),
            .barrier = true};
  }

 private:
  static std::vector<ExtraParameter> coefficients() {
    std::vector<ExtraParameter> list = {{.name = "share",
                                         .unit = "1",
                                         .meaning = "share of the shear modulus that I2bar carries",
                                         .fallback = 0,
                                         .min = 0,
                                         .max = 1},
                                        {.name = "softening",
                                         .unit = "1",
                                         .meaning = "share of I1bar^(3/4) in the rest, which softens with stretch",
                                         .fallback = 0,
                                         .min = 0,
                                         .max = 1}};
    const char* const stretches[] = {"0.03", "0.1", "0.3", "1", "3", "10", "30"};
    const char* const areas[] = {"1", "10", "100"};
    for (int i = 0; i < 7; ++i)
      list.push_back(growth("growth_" + std::to_string(i + 1), std::string("I1bar - 3 = ") + stretches[i]));
    for (int i = 0; i < 3; ++i)
      list.push_back(
          growth("area_growth_" + std::to_string(i + 1), std::string("I2bar^(3/2) - 3 sqrt 3 = ") + areas[i]));
    return list;
  }
  static ExtraParameter growth(std::string name, std::string place) {
    return {.name = std::move(name),
            .unit = "1",
            .meaning = "growth of the slope about " + std::move(place),
            .fallback = 0,
            .min = 0,
            .max = 1e3};
  }
};

using Spline = FromIsochoricInvariants<SplineLaw>;

}  // namespace aspic
