// Dissipation potential of the force-velocity relation of muscle [Hill 1938], beside the energy of muscle_law.h. With
// the stretch l = |F a|, l_n at the start of the step, and the relative velocity v = (l - l_n) / (h l0 v_max),
//   psi = T/l0 f(l_n/l0) (h l0 v_max) G(v),   G' = g(v) - 1
//   g = 0 for v < -1,   (1 + v) / (1 - v/k) for shortening,   1 + (m - 1) v / (v + c) for lengthening
// so that the stress is T/l0 f g, up to the change of f in the step. c = (m - 1) k / (k + 1) makes the slope continuous
// at v = 0. g increases, so G is convex and the loss (g - 1) v is never negative.
#pragma once
#include "material/from_stretch.h"

namespace aspic {

struct HillStretchLaw {
  template <class T>
  struct Params {
    T tension;             // T/l0 f(l_n/l0) [Pa]; 0 in statics
    T rate;                // 1 / (h l0 v_max)
    T start;               // l_n
    T curvature, plateau;  // k, m > 1
    T ax, ay, az;          // a
  };

  template <class T>
  static StretchResponse<T> response(const T& l, const Params<T>& p) {
    const T v = (l - p.start) * p.rate, one = T(1.0), zero = T(0.0), k = p.curvature;
    const T slow = where_positive(v + one, where_positive(v, zero, v), -one);  // within -1 to 0
    const T fast = where_positive(v, v, zero);
    const T rise = p.plateau - one, c = rise * k / (k + one);
    const auto by_part = [&](const T& stopped, const T& shortening, const T& lengthening) {
      return where_positive(v, lengthening, where_positive(v + one, shortening, stopped));
    };
    const T shortened = (k + one) * (-slow - k * log(one - slow / k)), to_k = k - slow, to_c = fast + c;
    const T G = by_part(shortened - (v + one), shortened, rise * (fast - c * log(one + fast / c)));
    const T slope = by_part(-one, (k + one) * slow / to_k, rise * fast / to_c);
    const T change = by_part(zero, (k + one) * k / (to_k * to_k), rise * c / (to_c * to_c));
    return {.energy = p.tension / p.rate * G, .slope = p.tension * slope, .curvature = p.tension * p.rate * change};
  }
};

using HillLaw = FromStretch<HillStretchLaw>;

}  // namespace aspic
