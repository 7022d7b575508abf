// Fibre energy of the transversely isotropic Mooney-Rivlin solid [Weiss 1996], for fibres along the unit vector a at
// rest: psi = F(l), l = |F a|, with
//   l F'(l) = 0 for l < 1,   C3 (exp(C4 (l - 1)) - 1) for l < l*,   C5 l + C6 beyond
// where the fibres are straight; C6 makes F' continuous. The second derivative jumps at l = 1 and l*. F is not split
// into volume and shape, as in fibre_law.h. The integral of F' has no closed form: ten Gauss points compute it with an
// error of 1e-12 of psi for C4 (l* - 1) <= 10.
#pragma once
#include "material/from_stretch.h"

namespace aspic {

struct WeissStretchLaw {
  template <class T>
  struct Params {
    T stiffness;           // C3 [Pa]
    T exponent;            // C4 [1]
    T straight;            // l* [1], > 1
    T straight_stiffness;  // C5 [Pa]
    T ax, ay, az;          // a
  };

  template <class T>
  static StretchResponse<T> response(const T& l, const Params<T>& p) {
    const T one = T(1.0), zero = T(0.0);
    const T bent = where_positive(l - p.straight, p.straight, where_positive(l - one, l, one));  // 1 <= bent <= l*
    const T beyond = where_positive(l - p.straight, l, p.straight);
    const T growth = exp(p.exponent * (bent - one)), pull = p.stiffness * (growth - one);
    const T C6 = p.stiffness * (exp(p.exponent * (p.straight - one)) - one) - p.straight_stiffness * p.straight;
    const T energy = p.stiffness * integral(bent, p.exponent) + p.straight_stiffness * (beyond - p.straight) +
                     C6 * log(beyond / p.straight);
    const T slope = pull / bent, curvature = (p.stiffness * p.exponent * growth - slope) / bent;
    const auto by_part = [&](const T& slack, const T& stretched, const T& straight) {
      return where_positive(l - p.straight, straight, where_positive(l - one, stretched, slack));
    };
    return {.energy = energy,
            .slope = by_part(zero, slope, p.straight_stiffness + C6 / beyond),
            .curvature = by_part(zero, curvature, -C6 / (beyond * beyond))};
  }

 private:
  // Integral of (exp(c (s - 1)) - 1) / s from 1 to l.
  template <class T>
  static T integral(const T& l, const T& c) {
    constexpr double kNode[5] = {0.14887433898163122, 0.4333953941292472, 0.6794095682990244, 0.8650633666889845,
                                 0.9739065285171717};
    constexpr double kWeight[5] = {0.29552422471475287, 0.26926671930999635, 0.21908636251598204, 0.1494513491505806,
                                   0.06667134430868814};
    const T half = T(0.5) * (l - T(1.0));
    T sum = T(0.0);
    for (int i = 0; i < 5; ++i)
      for (const double x : {1 - kNode[i], 1 + kNode[i]}) {
        const T d = x * half;
        sum = sum + kWeight[i] * ((exp(c * d) - T(1.0)) / (T(1.0) + d));
      }
    return half * sum;
  }
};

using WeissLaw = FromStretch<WeissStretchLaw>;

}  // namespace aspic
