// Energy of a family of fibres with dispersion, beside any material [Gasser 2006]:
//   psi = k1/(2 k2) (exp(k2 s(E)) - 1),   E = H : F'F - 1,   H = kappa I + (1 - 3 kappa) a a'
// for fibres along the unit vector a at rest. kappa = 0: all fibres along a; kappa = 1/3: in all directions alike. The
// fibres act in tension only: s = 0 for E < 0 and E^2 for E > eps, exactly, with a polynomial between that makes three
// derivatives continuous at 0 and two at eps. E is a convex function of F and psi a convex nondecreasing one of E, so
// Hessians are positive semidefinite. F is not split into volume and shape, which would let fibres stretch a
// compressible body without bound [Nolan 2014].
#pragma once
#include "material/from_invariants.h"
#include "math/pack.h"

namespace aspic {

struct FibreLaw {
  static constexpr double kEps = 0.03;  // strain E over which fibres straighten

  template <class T>
  struct Params {
    T k1;          // [Pa]
    T k2, kappa;   // [1]
    T ax, ay, az;  // a
  };

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    return response(F, structure(p), p).energy;
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    const Mat3<T> H = structure(p);
    return T(2.0) * response(F, H, p).slope * (F * H);
  }
  // d2psi/dF2 = 2 psi' (I x H) + psi'' G G',  G = dE/dF = 2 F H
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    const Mat3<T> H = structure(p), G = T(2.0) * (F * H);
    const Response<T> f = response(F, H, p);
    Mat9<T> A;
    for (int d = 0; d < 3; ++d)
      for (int s = 0; s < 3; ++s)
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) {
            const T outer = f.curvature * G(r, c) * G(s, d);
            A(r + 3 * c, s + 3 * d) = r == s ? outer + T(2.0) * f.slope * H(c, d) : outer;
          }
    return A;
  }

 private:
  // psi and its derivatives with respect to E.
  template <class T>
  struct Response {
    T energy, slope, curvature;
  };

  template <class T>
  static Mat3<T> structure(const Params<T>& p) {
    const Vec3<T> a = {{p.ax, p.ay, p.az}};
    return p.kappa * identity3<T>() + (T(1.0) - T(3.0) * p.kappa) * outer(a, a);
  }

  // Returns f(E) for E < 0, 0 <= E <= eps and E > eps.
  template <class T>
  static T piecewise(const T& E, const T& slack, const T& between, const T& taut) {
    return where_positive(E, where_positive(E - T(kEps), taut, between), slack);
  }

  template <class T>
  static Response<T> response(const Mat3<T>& F, const Mat3<T>& H, const Params<T>& p) {
    const T E = inner(F * H, F) - T(1.0), t = E * T(1 / kEps), zero = T(0.0), t4 = t * t * t * t;
    const T s = piecewise(E, zero, T(kEps * kEps / 3) * t4 * (T(10.0) + t * t * (T(8.0) * t - T(15.0))), E * E);
    const T ds = piecewise(E, zero, T(kEps / 3) * t * t * t * (T(40.0) + t * t * (T(56.0) * t - T(90.0))), T(2.0) * E);
    const T dds = piecewise(E, zero, t * t * (T(40.0) + t * t * (T(112.0) * t - T(150.0))), T(2.0));
    const T growth = exp(p.k2 * s);
    return {.energy = T(0.5) * p.k1 / p.k2 * (growth - T(1.0)),
            .slope = T(0.5) * p.k1 * growth * ds,
            .curvature = T(0.5) * p.k1 * growth * (dds + p.k2 * ds * ds)};
  }
};

}  // namespace aspic
