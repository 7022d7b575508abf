// A Pack is kPackWidth doubles in one SIMD vector. SIMD code is confined to this file.
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>

#include "base/compat.h"

namespace aspic {

// Lets unqualified calls on a double never convert to Pack.
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

// Arithmetic is lane by lane.
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

// Applies fn lane by lane. A vector math library would replace this function.
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

// Bits of the lanes as integers: sign, 11 bits of exponent, 52 bits of mantissa.
using PackBits __attribute__((vector_size(kPackWidth * sizeof(double)))) = long long;

// Returns whether all lanes are positive, normal and small enough that sums of a few do not overflow.
inline bool all_ordinary(Pack a) {
  bool all = true;
  for (int i = 0; i < kPackWidth; ++i)
    all &= a[i] >= std::numeric_limits<double>::min() && a[i] <= std::numeric_limits<double>::max() / 8;
  return all;
}

// Accurate to 1 ulp. x = 2^k m with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh s = 2s (1 + s^2/3 + s^4/5 + ...), s =
// f/(2 + f), f = m - 1, s^2 < 0.0295. Because 2s = f - s f, ln m = f - s (f - R), R = 2 s^2/3 + 2 s^4/5 + ...
inline Pack log(Pack a) {
  if (!all_ordinary(a)) return map(a, [](double x) { return std::log(x); });
  constexpr long long kSqrtHalf = bit_cast<long long>(0.70710678118654752);
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

// Cube root, accurate to 2 ulp. A third of the exponent is accurate to some percent; Halley's iteration triples the
// digits, and a final Newton step rounds once.
inline Pack cbrt(Pack a) {
  if (!all_ordinary(a)) return map(a, [](double x) { return std::cbrt(x); });
  constexpr double kTwoThirdsOfOne = 2.0 / 3 * static_cast<double>(bit_cast<long long>(0.97));
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

// Returns condition > 0 ? a : b, lane by lane.
inline Pack where_positive(Pack condition, Pack a, Pack b) { return condition.v > 0 ? a.v : b.v; }
inline double where_positive(double condition, double a, double b) { return condition > 0 ? a : b; }

inline Pack max(Pack a, Pack b) { return where_positive(a - b, a, b); }
inline double max(double a, double b) { return where_positive(a - b, a, b); }
inline Pack abs(Pack a) { return where_positive(a, a, -a); }

// Sets bit l if lane l is not > 0, or is NaN.
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

// Returns 1 in the lanes whose bit is set, 0 in the others.
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

// Adds the lanes in order, so that rounding is the same on all platforms.
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

// Prefetches the cache lines of these bytes.
inline void prefetch(const void* from, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; i += 64) __builtin_prefetch(static_cast<const char*>(from) + i);
}

// Transposition between rows of values in memory, one row per lane, and packs, one per column, for gather and scatter.
// Rows are moved in pieces of register width, and shuffles turn them into columns. Accesses no memory outside the rows.
// `row(lane)` returns the address of the first value.

// Vector of N doubles, loaded and stored at any alignment.
template <int N>
struct Vector {
  using Type __attribute__((vector_size(N * sizeof(double)))) = double;
};
template <int N>
typename Vector<N>::Type load(const double* from) {
  typename Vector<N>::Type a;
  std::memcpy(&a, from, sizeof a);
  return a;
}
template <int N>
void add(typename Vector<N>::Type a, double* to) {
  a += load<N>(to);
  std::memcpy(to, &a, sizeof a);
}

// Returns a0 b0 a1 b1 ... from the lower or the upper halves of a and b.
template <bool kUpper, int... I>
Pack zip(Pack a, Pack b, std::integer_sequence<int, I...>) {
  constexpr int kFirst = kUpper ? kPackWidth / 2 : 0;
  return Pack::Lanes(__builtin_shufflevector(a.v, b.v, (kFirst + I / 2 + I % 2 * kPackWidth)...));
}
using LaneNumbers = std::make_integer_sequence<int, kPackWidth>;

// Zipping the halves of the list moves the highest bit of the position to the lowest bit of the lane. Doing so once per
// bit transposes positions and lanes.
inline void transpose(Pack* a) {
  constexpr int kHalf = kPackWidth / 2;
  for (int stage = 1; stage < kPackWidth; stage *= 2) {
    Pack b[kPackWidth];
    for (int i = 0; i < kHalf; ++i) {
      b[2 * i] = zip<false>(a[i], a[i + kHalf], LaneNumbers());
      b[2 * i + 1] = zip<true>(a[i], a[i + kHalf], LaneNumbers());
    }
    for (int i = 0; i < kPackWidth; ++i) a[i] = b[i];
  }
}

// kOdd = 0: a0 b0 a2 b2 ...; kOdd = 1: a1 b1 a3 b3 ...
template <int kOdd, int... I>
Pack alternate(Pack a, Pack b, std::integer_sequence<int, I...>) {
  return Pack::Lanes(__builtin_shufflevector(a.v, b.v, (kOdd + I / 2 * 2 + I % 2 * kPackWidth)...));
}

// Loads N values from the rows of every second lane.
template <int N, class Row>
typename Vector<N>::Type load_pairs(const Row& row, int lane, int column) {
  if constexpr (N == 2) {
    return load<2>(row(lane) + column);
  } else {
    const auto concatenate = [](auto a, auto b) {
      if constexpr (N == 4) return __builtin_shufflevector(a, b, 0, 1, 2, 3);
      if constexpr (N == 8) return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
    };
    return concatenate(load_pairs<N / 2>(row, lane, column), load_pairs<N / 2>(row, lane + N / 2, column));
  }
}

template <class Row>
std::array<Pack, 3> gather3(const Row& row) {
  const auto pairs = [&row](int lane, int column) { return Pack(load_pairs<kPackWidth>(row, lane, column)); };
  const Pack xy_even = pairs(0, 0), xy_odd = pairs(1, 0);
  return {alternate<0>(xy_even, xy_odd, LaneNumbers()), alternate<1>(xy_even, xy_odd, LaneNumbers()),
          alternate<1>(pairs(0, 1), pairs(1, 1), LaneNumbers())};
}

// Adds row[c] += a[c] lane by lane, so that lanes may share a row.
template <class Row>
void scatter3(const std::array<Pack, 3>& a, const Row& row) {
  const Pack even = alternate<0>(a[0], a[1], LaneNumbers()), odd = alternate<1>(a[0], a[1], LaneNumbers());
  const auto add_pair = [&]<int kLane>() {
    constexpr int k = kLane / 2 * 2;
    const Pack& pairs = kLane % 2 == 0 ? even : odd;
    add<2>(__builtin_shufflevector(pairs.v, pairs.v, k, k + 1), row(kLane));
    row(kLane)[2] += a[2][kLane];
  };
  [&]<int... I>(std::integer_sequence<int, I...>) { (add_pair.template operator()<I>(), ...); }
  (LaneNumbers());
}
template <class Row>
void scatter9(std::array<Pack, 9> a, const Row& row) {
  for (int c = 0; c < 8; c += kPackWidth) {
    transpose(&a[c]);
    for (int lane = 0; lane < kPackWidth; ++lane) add<kPackWidth>(a[c + lane].v, row(lane) + c);
  }
  for (int lane = 0; lane < kPackWidth; ++lane) row(lane)[8] += a[8][lane];
}

}  // namespace aspic
