// Energy of passive heart muscle with fibres along the unit vector a at rest [Guccione 1991]:
//   psi = C/2 (exp(Q) - 1),   Q = bf Eaa^2 + bt (Ess^2 + Enn^2 + 2 Esn^2) + 2 bfs (Eas^2 + Ean^2),   E = (F'F - I)/2
// for any s and n across a: Q = E : B E with
//   B E = bt E + (bf - 2 bfs + bt) (a . E a) a a' + (bfs - bt) (E a a' + a (E a)')
// For bf = bt = bfs the energy is isotropic. psi is +inf where the exponential overflows.
#pragma once
#include "math/pack.h"
#include "math/small.h"

namespace aspic {

struct GuccioneLaw {
  template <class T>
  struct Params {
    T stiffness;             // C [Pa]
    T along, across, shear;  // bf, bt, bfs [1]
    T ax, ay, az;            // a
  };

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    const Strain<T> s(F, p);
    return T(0.5) * p.stiffness * (exp(s.Q) - T(1.0));
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    const Strain<T> s(F, p);
    return (p.stiffness * exp(s.Q)) * (F * s.BE);
  }
  // dP = C e^Q (dF BE + F B dE + 2 (BE : dE) F BE), dE = sym(F' dF)
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    const Strain<T> s(F, p);
    const T k = p.stiffness * exp(s.Q), half_across = T(0.5) * p.across, half_mixed = T(0.5) * mixed(p);
    const T fibre = pure(p);
    const Vec3<T> a = axis(p), f = F * a;
    const Mat3<T> FFt = F * transpose(F), G = F * s.BE;
    Mat9<T> H;
    for (int d = 0; d < 3; ++d)
      for (int v = 0; v < 3; ++v)
        for (int c = 0; c < 3; ++c)
          for (int u = 0; u < 3; ++u) {
            T h = half_across * F(u, d) * F(v, c) + fibre * f[u] * a[c] * f[v] * a[d] +
                  half_mixed * (FFt(u, v) * a[c] * a[d] + F(u, d) * f[v] * a[c] + f[u] * F(v, c) * a[d]) +
                  T(2.0) * G(u, c) * G(v, d);
            if (c == d) h = h + half_across * FFt(u, v) + half_mixed * f[u] * f[v];
            if (u == v) h = h + s.BE(c, d);
            H(u + 3 * c, v + 3 * d) = k * h;
          }
    return H;
  }

 private:
  template <class T>
  struct Strain {
    Mat3<T> BE;
    T Q;

    Strain(const Mat3<T>& F, const Params<T>& p) {
      const Vec3<T> a = axis(p);
      const Mat3<T> E = T(0.5) * (transpose(F) * F - identity3<T>());
      const Vec3<T> Ea = E * a;
      BE = p.across * E + (pure(p) * dot(a, Ea)) * outer(a, a) + mixed(p) * (outer(Ea, a) + outer(a, Ea));
      Q = inner(E, BE);
    }
  };

  template <class T>
  static Vec3<T> axis(const Params<T>& p) {
    return {{p.ax, p.ay, p.az}};
  }
  template <class T>
  static T pure(const Params<T>& p) {
    return p.along - T(2.0) * p.shear + p.across;
  }
  template <class T>
  static T mixed(const Params<T>& p) {
    return p.shear - p.across;
  }
};

}  // namespace aspic
