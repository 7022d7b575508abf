// Scalar type that counts its operations. Materials accept any scalar, so evaluating one with this type counts the
// flops of its formula as written. A kernel with fewer flops is faster than this bound.
#pragma once
#include "math/small.h"
#include "math/svd3.h"

namespace aspic::bench {

struct Counted {
  double value = 1;
  static inline double flops = 0;

  Counted() = default;
  Counted(double x) : value(x) {}

  friend Counted operator+(Counted a, Counted b) { return one_more(a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return one_more(a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return one_more(a.value * b.value); }
  friend Counted operator/(Counted a, Counted b) { return one_more(a.value / b.value); }
  friend Counted operator-(Counted a) { return a; }  // merged into the next operation
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }

  static Counted one_more(double x) { return several(1, x); }
  static Counted several(double count, double x) {
    flops += count;
    return x;
  }

  // Counts of math/pack.h; exp and pow are estimates of the same order.
  friend Counted log(Counted a) { return several(36, std::log(a.value)); }
  friend Counted cbrt(Counted a) { return several(22, std::cbrt(a.value)); }
  friend Counted exp(Counted a) { return several(25, std::exp(a.value)); }
  friend Counted pow(Counted a, double n) { return several(60, std::pow(a.value, n)); }
  friend Counted sqrt(Counted a) { return one_more(std::sqrt(a.value)); }
  friend Counted abs(Counted a) { return std::abs(a.value); }
  friend Counted max(Counted a, Counted b) { return one_more(std::max(a.value, b.value)); }
  friend Counted where_positive(Counted condition, Counted a, Counted b) { return condition.value > 0 ? a : b; }
  friend unsigned lanes_not_positive(Counted a) { return !(a.value > 0); }
  friend bool any_positive(Counted a) { return a.value > 0; }
};

// The rotations of Jacobi's method are not counted because their number depends on F.
inline Svd3<Counted> svd3(const Mat3<Counted>& F) {
  Mat3d value;
  for (int i = 0; i < 9; ++i) value.a[i] = F.a[i].value;
  const Svd3<double> f = aspic::svd3(value);
  Svd3<Counted> counted;
  for (int i = 0; i < 9; ++i) counted.U.a[i] = f.U.a[i], counted.V.a[i] = f.V.a[i];
  for (int i = 0; i < 3; ++i) counted.s[i] = f.s[i];
  return counted;
}

}  // namespace aspic::bench
