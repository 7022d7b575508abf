// Convex splines with knots 0 = t_0 < t_1 < ... < t_(N+1), for data-driven energy densities:
//   g(x) = sum over i = 1..N of c_i B_i(x),   B_i'' = 2 hat_i / (t_(i+1) - t_(i-1)),   B_i(0) = B_i'(0) = 0
// hat_i is the piecewise linear function that is 1 at t_i and 0 at all other knots, so the slope B_i' rises smoothly
// from 0 before t_(i-1) to 1 beyond t_(i+1) (the I-splines of [Ramsay 1988]). For c >= 0, g is convex and nondecreasing
// on the whole line, with a continuous g''. It is 0 before 0 and linear beyond the last knot.
#pragma once
#include <array>
#include <cstddef>

#include "math/pack.h"

namespace aspic {

// Value and derivatives of a function of one variable.
template <class T>
struct Curve {
  T value, slope, curvature;
};

template <std::size_t N>
struct ConvexSpline {
  std::array<double, N + 2> knots;

  template <class T>
  Curve<T> operator()(const T& x, const T (&c)[N]) const {
    Curve<T> g{T(0.0), T(0.0), T(0.0)};
    T start = T(0.0);  // g'' at the left end of the piece
    for (std::size_t k = 0; k <= N; ++k) {
      const double length = knots[k + 1] - knots[k];
      const T end = k < N ? T(2 / (knots[k + 2] - knots[k])) * c[k] : T(0.0), rise = end - start;
      const T u = limited(T(1 / length) * (x - T(knots[k])));  // fraction of the piece before x
      g.value = g.value + T(length * length) * u * u * (T(0.5) * start + T(1.0 / 6) * rise * u) +
                T(length) * (start + T(0.5) * rise) * positive_part(x - T(knots[k + 1]));
      g.slope = g.slope + T(length) * u * (start + T(0.5) * rise * u);
      const T here = where_positive(u, start + rise * u, T(0.0));
      g.curvature = g.curvature + where_positive(x - T(knots[k + 1]), T(0.0), here);
      start = end;
    }
    return g;
  }

 private:
  template <class T>
  static T positive_part(const T& x) {
    return where_positive(x, x, T(0.0));
  }
  template <class T>
  static T limited(const T& u) {  // clamps to [0, 1]
    return where_positive(u - T(1.0), T(1.0), positive_part(u));
  }
};

}  // namespace aspic
