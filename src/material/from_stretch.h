// Energies psi(l) of the stretch l = |F a| of fibres along the unit vector a at rest:
//   P = psi'/l f a',   d2psi/dF2 = psi'/l (I x aa') + (psi'' - psi'/l) / l^2 (f a') (f a')',   f = F a
#pragma once
#include "math/pack.h"
#include "math/small.h"

namespace aspic {

// psi and its derivatives with respect to l.
template <class T>
struct StretchResponse {
  T energy, slope, curvature;
};

// L defines Params<T> with the members ax, ay, az, and response(l, p).
template <class L>
struct FromStretch : L {
  template <class T>
  using Params = typename L::template Params<T>;

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    return L::response(length(F * axis(p)), p).energy;
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    const Vec3<T> a = axis(p), f = F * a;
    const T l = length(f);
    return outer((L::response(l, p).slope / l) * f, a);
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    const Vec3<T> a = axis(p), f = F * a;
    const T l = length(f);
    const StretchResponse<T> r = L::response(l, p);
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

  template <class P>
  static auto axis(const P& p) {
    return Vec3<decltype(p.ax + p.ax)>{{p.ax, p.ay, p.az}};
  }
  template <class T>
  static T length(const Vec3<T>& f) {
    return sqrt(dot(f, f));
  }
};

}  // namespace aspic
