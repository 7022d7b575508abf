// A Pack is kPackWidth doubles that move together. The only file that knows that SIMD lanes exist.
#pragma once
#include <cmath>

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
  typedef double Lanes __attribute__((vector_size(kPackWidth * sizeof(double))));
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
inline Pack log(Pack a) {
  return map(a, [](double x) { return std::log(x); });
}
inline Pack cbrt(Pack a) {
  return map(a, [](double x) { return std::cbrt(x); });
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
