// Energy of active muscle fibres along the unit vector a at rest [Blemker 2005]: psi = T Phi(l/l0), l = |F a|, where T
// is the strength times the activation and Phi' = f(x) the active force over the stretch: 9 (x - 0.4)^2 up to 0.6,
// 1 - 4 (1 - x)^2 up to 1.4, 9 (x - 1.6)^2 up to 1.6, else 0. The nominal stress is T/l0 f(l/l0). Beyond x = 1 the
// force falls, so psi is not convex there.
#pragma once
#include "material/from_stretch.h"

namespace aspic {

// Chooses the value of the part of the force-stretch curve that contains the relative stretch x.
template <class T>
T by_part_of_muscle(const T& x, const T (&part)[5]) {
  T chosen = part[0];
  constexpr double kStart[4] = {0.4, 0.6, 1.4, 1.6};
  for (int i = 0; i < 4; ++i) chosen = where_positive(x - T(kStart[i]), part[i + 1], chosen);
  return chosen;
}

// f(x) and f'(x).
template <class T>
struct MuscleForce {
  T force, change;
};
template <class T>
MuscleForce<T> muscle_force(const T& x) {
  const T low = x - T(0.4), mid = x - T(1.0), high = x - T(1.6), zero = T(0.0);
  const T force[5] = {zero, T(9.0) * low * low, T(1.0) - T(4.0) * mid * mid, T(9.0) * high * high, zero};
  const T change[5] = {zero, T(18.0) * low, T(-8.0) * mid, T(18.0) * high, zero};
  return {by_part_of_muscle(x, force), by_part_of_muscle(x, change)};
}

struct MuscleStretchLaw {
  template <class T>
  struct Params {
    T tension;     // [Pa]
    T optimal;     // l0 [1]
    T ax, ay, az;  // a
  };

  template <class T>
  static StretchResponse<T> response(const T& l, const Params<T>& p) {
    const T x = l / p.optimal, low = x - T(0.4), mid = x - T(1.0), high = x - T(1.6), zero = T(0.0);
    const T energy[5] = {zero, T(3.0) * low * low * low,
                         T(0.024) + (x - T(0.6)) - T(4.0 / 3.0) * (mid * mid * mid + T(0.064)),
                         T(0.824 - 0.512 / 3) + T(3.0) * (high * high * high + T(0.008)), T(0.848 - 0.512 / 3)};
    const MuscleForce<T> f = muscle_force(x);
    const T per_length = p.tension / p.optimal;
    return {.energy = p.tension * by_part_of_muscle(x, energy),
            .slope = per_length * f.force,
            .curvature = per_length / p.optimal * f.change};
  }
};

using MuscleLaw = FromStretch<MuscleStretchLaw>;

}  // namespace aspic
