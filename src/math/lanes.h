// N values in one SIMD vector: a column of a 3x3 block or three components of a vector with an unused lane (N = 4), or
// four of these (N = 16). Loads of three values also read the value after them, so arrays need kSpareLanes more entries
// at the end. Unlike the lanes of a Pack, the lanes are consecutive in memory.
#pragma once
#include <cstring>

namespace aspic {

inline constexpr int kSpareLanes = 4;

template <class T, int N>
struct Lanes {
  using Values __attribute__((vector_size(N * sizeof(T)))) = T;
  Values v;

  static Lanes zero() { return {Values{}}; }
  static Lanes all(T s) { return {s - Values{}}; }
  static Lanes load(const T* p) {
    Lanes a;
    std::memcpy(&a.v, p, sizeof(Values));
    return a;
  }
  void store(T* p) const { std::memcpy(p, &v, sizeof(Values)); }
  T operator[](int lane) const { return v[lane]; }

  friend Lanes operator+(Lanes a, Lanes b) { return {a.v + b.v}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {a.v - b.v}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {a.v * b.v}; }
  Lanes& operator+=(Lanes b) { return v += b.v, *this; }
  Lanes& operator-=(Lanes b) { return v -= b.v, *this; }
};

template <class T>
using Quad = Lanes<T, 4>;

// Loads three values; the unused lane is 0.
template <class T>
Quad<T> load3(const T* p) {
  return {typename Quad<T>::Values{p[0], p[1], p[2], 0}};
}
template <class T>
void store3(Quad<T> q, T* p) {
  for (int i = 0; i < 3; ++i) p[i] = q[i];
}

// Returns A x for a column-major 3x3 block.
template <class T>
Quad<T> product(const T* A, const T* x) {
  return Quad<T>::load(A) * Quad<T>::all(x[0]) + Quad<T>::load(A + 3) * Quad<T>::all(x[1]) +
         Quad<T>::load(A + 6) * Quad<T>::all(x[2]);
}

// Returns A' x for a column-major 3x3 block and x = {x0, x1, x2, 0}; the unused lane of the result is 0.
template <class T>
Quad<T> transposed_product(const T* A, Quad<T> x) {
  using Q = Quad<T>;
  const Q a = Q::load(A) * x, b = Q::load(A + 3) * x, c = Q::load(A + 6) * x, o = Q::zero();
  // Computes a0 + a1, b0 + b1, a2 + a3, b2 + b3, and similarly for c and o.
  const Q ab = {__builtin_shufflevector(a.v, b.v, 0, 4, 2, 6) + __builtin_shufflevector(a.v, b.v, 1, 5, 3, 7)};
  const Q co = {__builtin_shufflevector(c.v, o.v, 0, 4, 2, 6) + __builtin_shufflevector(c.v, o.v, 1, 5, 3, 7)};
  return {__builtin_shufflevector(ab.v, co.v, 0, 1, 4, 5) + __builtin_shufflevector(ab.v, co.v, 2, 3, 6, 7)};
}

}  // namespace aspic
