// Energy of a constant active tension along the unit vector a at rest [Land 2015]: psi = T/2 (I4 - 1), I4 = |F a|^2.
// The second Piola-Kirchhoff stress is T a a'.
#pragma once
#include "math/pack.h"
#include "math/small.h"

namespace aspic {

struct TensionLaw {
  template <class T>
  struct Params {
    T tension;     // [Pa]
    T ax, ay, az;  // a
  };

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    const Vec3<T> f = F * axis(p);
    return T(0.5) * p.tension * (dot(f, f) - T(1.0));
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    return outer(p.tension * (F * axis(p)), axis(p));
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>&, const Params<T>& p) {
    const Vec3<T> a = axis(p);
    Mat9<T> H;
    for (int d = 0; d < 3; ++d)
      for (int s = 0; s < 3; ++s)
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) H(r + 3 * c, s + 3 * d) = r == s ? p.tension * a[c] * a[d] : T(0.0);
    return H;
  }

 private:
  template <class T>
  static Vec3<T> axis(const Params<T>& p) {
    return {{p.ax, p.ay, p.az}};
  }
};

}  // namespace aspic
