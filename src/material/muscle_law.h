// Energy of active muscle fibres along the unit vector a at rest [Blemker 2005]: psi = T Phi(l/l0), l = |F a|, where T
// is the strength times the activation and Phi' = f(x) the active force over the stretch: 9 (x - 0.4)^2 up to 0.6, 1 -
// 4 (1
// - x)^2 up to 1.4, 9 (x - 1.6)^2 up to 1.6, else 0. The nominal stress is T/l0 f(l/l0). Beyond x = 1 the force falls,
// so psi is not convex there.
#pragma once
#include "math/pack.h"
#include "math/small.h"

namespace aspic {

struct MuscleLaw {
  template <class T>
  struct Params {
    T tension;     // [Pa]
    T optimal;     // l0 [1]
    T ax, ay, az;  // a
  };

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    return response(length(F * axis(p)), p).energy;
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    const Vec3<T> a = axis(p), f = F * a;
    const T l = length(f);
    return outer((response(l, p).slope / l) * f, a);
  }
  // d2psi/dF2 = psi'/l (I x aa') + (psi'' - psi'/l) / l^2 (f a') (f a')',  f = F a
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    const Vec3<T> a = axis(p), f = F * a;
    const T l = length(f);
    const Response<T> r = response(l, p);
    const T across = r.slope / l, along = (r.curvature - across) / (l * l);
    Mat9<T> H;
    for (int d = 0; d < 3; ++d)
      for (int s = 0; s < 3; ++s)
        for (int c = 0; c < 3; ++c)
          for (int t = 0; t < 3; ++t) {
            const T block = along * f[t] * f[s];
            H(t + 3 * c, s + 3 * d) = (t == s ? block + across : block) * a[c] * a[d];
          }
    return H;
  }

 private:
  // psi and its derivatives with respect to l.
  template <class T>
  struct Response {
    T energy, slope, curvature;
  };

  template <class T>
  static Vec3<T> axis(const Params<T>& p) {
    return {{p.ax, p.ay, p.az}};
  }
  template <class T>
  static T length(const Vec3<T>& f) {
    return sqrt(dot(f, f));
  }
  // Chooses by the part of the force-stretch curve.
  template <class T>
  static T by_part(const T& x, const T (&part)[5]) {
    T chosen = part[0];
    constexpr double kStart[4] = {0.4, 0.6, 1.4, 1.6};
    for (int i = 0; i < 4; ++i) chosen = where_positive(x - T(kStart[i]), part[i + 1], chosen);
    return chosen;
  }

  template <class T>
  static Response<T> response(const T& l, const Params<T>& p) {
    const T x = l / p.optimal, low = x - T(0.4), mid = x - T(1.0), high = x - T(1.6), zero = T(0.0);
    const T energy[5] = {zero, T(3.0) * low * low * low,
                         T(0.024) + (x - T(0.6)) - T(4.0 / 3.0) * (mid * mid * mid + T(0.064)),
                         T(0.824 - 0.512 / 3) + T(3.0) * (high * high * high + T(0.008)), T(0.848 - 0.512 / 3)};
    const T force[5] = {zero, T(9.0) * low * low, T(1.0) - T(4.0) * mid * mid, T(9.0) * high * high, zero};
    const T change[5] = {zero, T(18.0) * low, T(-8.0) * mid, T(18.0) * high, zero};
    const T per_length = p.tension / p.optimal;
    return {.energy = p.tension * by_part(x, energy),
            .slope = per_length * by_part(x, force),
            .curvature = per_length / p.optimal * by_part(x, change)};
  }
};

}  // namespace aspic
