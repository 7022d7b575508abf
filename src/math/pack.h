// A Pack is kPackWidth doubles that move together. The only file that knows that SIMD lanes exist.
#pragma once
#include <bit>
#include <cmath>
#include <limits>

namespace aspic {

// So that unqualified calls on a double never convert to Pack.
using std::abs;
using std::cbrt;
using std::exp;
using std::log;
using std::pow;
using std::sqrt;

#if defined(__AVX512F__)
inline constexpr int kPackWidth = 8;
#elif defined(__AVX__)
inline constexpr int kPackWidth = 4;
#else
inline constexpr int kPackWidth = 2;
#endif

struct Pack {
  using Lanes __attribute__((vector_size(kPackWidth * sizeof(double)))) = double;
  Lanes v;
  Pack() = default;
  Pack(double s) : v(s - Lanes{}) {}
  Pack(Lanes lanes) : v(lanes) {}
  double operator[](int lane) const { return v[lane]; }
  void set(int lane, double s) { v[lane] = s; }
  friend Pack operator+(Pack a, Pack b) { return a.v + b.v; }
  friend Pack operator-(Pack a, Pack b) { return a.v - b.v; }
  friend Pack operator*(Pack a, Pack b) { return a.v * b.v; }
  friend Pack operator/(Pack a, Pack b) { return a.v / b.v; }
  friend Pack operator-(Pack a) { return -a.v; }
  Pack& operator+=(Pack b) { return v += b.v, *this; }
  Pack& operator-=(Pack b) { return v -= b.v, *this; }
  Pack& operator*=(Pack b) { return v *= b.v, *this; }
};

// Applies fn lane by lane; a vector math library can replace it here and nowhere else.
template <class Fn>
Pack map(Pack a, Fn fn) {
  for (int i = 0; i < kPackWidth; ++i) a.v[i] = fn(a[i]);
  return a;
}
inline Pack sqrt(Pack a) {
  return map(a, [](double x) { return std::sqrt(x); });
}
inline Pack exp(Pack a) {
  return map(a, [](double x) { return std::exp(x); });
}

// The bits of the lanes as integers: sign, 11 bits of exponent, 52 of mantissa.
using PackBits __attribute__((vector_size(kPackWidth * sizeof(double)))) = long long;

// Positive, normal and small enough that a few of them add up without overflow.
inline bool all_ordinary(Pack a) {
  bool all = true;
  for (int i = 0; i < kPackWidth; ++i)
    all &= a[i] >= std::numeric_limits<double>::min() && a[i] <= std::numeric_limits<double>::max() / 8;
  return all;
}

// Within 1 ulp. x = 2^k m with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh s = 2s (1 + s^2/3 + s^4/5 + ...),
// s = f/(2 + f), f = m - 1, s^2 < 0.0295. As 2s = f - s f, ln m = f - s (f - R), R = 2 s^2/3 + 2 s^4/5 + ...
inline Pack log(Pack a) {
  if (!all_ordinary(a)) return map(a, [](double x) { return std::log(x); });
  constexpr long long kSqrtHalf = std::bit_cast<long long>(0.70710678118654752);
  constexpr double kLn2High = 0x1.62e42fefa0000p-1, kLn2Low = 0x1.cf79abc9e3b3ap-40;  // k * high is exact
  const PackBits bits = (PackBits)a.v, k_bits = (bits - kSqrtHalf) >> 52;
  const Pack k = __builtin_convertvector(k_bits, Pack::Lanes);
  const Pack f = Pack((Pack::Lanes)(bits - (k_bits << 52))) - 1.0;
  const Pack s = f / (2.0 + f), z = s * s;
  Pack R = 2.0 / 23;
  for (int odd = 21; odd >= 3; odd -= 2) R = 2.0 / odd + z * R;
  R *= z;
  return k * kLn2High - ((s * (f - R) - k * kLn2Low) - f);
}

// Within 2 ulp. A third of the exponent is right to some percent; Halley's iteration triples the digits, and
// Newton's last one rounds once.
inline Pack cbrt(Pack a) {
  if (!all_ordinary(a)) return map(a, [](double x) { return std::cbrt(x); });
  constexpr double kTwoThirdsOfOne = 2.0 / 3 * static_cast<double>(std::bit_cast<long long>(0.97));
  const Pack bits = __builtin_convertvector((PackBits)a.v, Pack::Lanes);
  const Pack third = (1.0 / 3) * bits + kTwoThirdsOfOne;
  Pack y((Pack::Lanes) __builtin_convertvector(third.v, PackBits));
  for (int i = 0; i < 2; ++i) {
    const Pack cube = y * y * y;
    y = y * ((cube + 2.0 * a) / (2.0 * cube + a));
  }
  return y - (y * y * y - a) / (3.0 * (y * y));
}
inline Pack pow(Pack a, double n) {
  return map(a, [n](double x) { return std::pow(x, n); });
}

// condition > 0 ? a : b, lane by lane.
inline Pack where_positive(Pack condition, Pack a, Pack b) { return condition.v > 0 ? a.v : b.v; }
inline double where_positive(double condition, double a, double b) { return condition > 0 ? a : b; }

inline Pack max(Pack a, Pack b) { return where_positive(a - b, a, b); }
inline double max(double a, double b) { return where_positive(a - b, a, b); }
inline Pack abs(Pack a) { return where_positive(a, a, -a); }

// Bit l is set where lane l is not > 0 (NaN is not).
inline unsigned lanes_not_positive(Pack a) {
  unsigned bits = 0;
  for (int i = 0; i < kPackWidth; ++i) bits |= unsigned{!(a[i] > 0)} << i;
  return bits;
}
inline unsigned lanes_not_positive(double a) { return !(a > 0); }

inline bool any_positive(Pack a) {
  for (int i = 0; i < kPackWidth; ++i)
    if (a[i] > 0) return true;
  return false;
}
inline bool any_positive(double a) { return a > 0; }

// 1 in the lanes whose bit is set, 0 in the others.
template <class T>
T lanes_from_bits(unsigned bits);
template <>
inline Pack lanes_from_bits<Pack>(unsigned bits) {
  Pack a;
  for (int i = 0; i < kPackWidth; ++i) a.set(i, bits >> i & 1);
  return a;
}
template <>
inline double lanes_from_bits<double>(unsigned bits) {
  return bits & 1;
}

// Lanes are added in order, so that the sum rounds alike everywhere.
inline double sum(Pack a) {
  double s = 0;
  for (int i = 0; i < kPackWidth; ++i) s += a[i];
  return s;
}
inline double min(Pack a) {
  double m = a[0];
  for (int i = 1; i < kPackWidth; ++i) m = a[i] < m ? a[i] : m;
  return m;
}

}  // namespace aspic
