// First-order forward automatic differentiation in one direction: a value and its derivative. T is double, Pack, or
// Dual for mixed second derivatives.
#pragma once
#include <concepts>

#include "math/pack.h"
#include "math/small.h"

namespace aspic {

template <class T>
struct Dual {
  T value, rate;

  Dual() = default;
  Dual(double constant) : value(constant), rate(0.0) {}
  explicit Dual(const T& constant) requires(!std::same_as<T, double>) : value(constant), rate(0.0) {}
  Dual(const T& v, const T& r) : value(v), rate(r) {}

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.rate + b.rate}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.rate - b.rate}; }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.rate}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.rate * b.value + a.value * b.rate};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T q = a.value / b.value;
    return {q, (a.rate - q * b.rate) / b.value};
  }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
};

template <class T>
Dual<T> sqrt(const Dual<T>& a) {
  const T root = sqrt(a.value);
  return {root, T(0.5) * a.rate / root};
}
template <class T>
Dual<T> cbrt(const Dual<T>& a) {
  const T root = cbrt(a.value);
  return {root, a.rate / (T(3.0) * root * root)};
}
template <class T>
Dual<T> exp(const Dual<T>& a) {
  const T e = exp(a.value);
  return {e, e * a.rate};
}
template <class T>
Dual<T> log(const Dual<T>& a) {
  return {log(a.value), a.rate / a.value};
}
// a^n for a constant n.
template <class T>
Dual<T> pow(const Dual<T>& a, double n) {
  const T power = pow(a.value, n - 1);
  return {power * a.value, T(n) * power * a.rate};
}

// The value selects the branch; the derivative is that of the selected branch.
template <class T>
Dual<T> where_positive(const Dual<T>& condition, const Dual<T>& a, const Dual<T>& b) {
  return {where_positive(condition.value, a.value, b.value), where_positive(condition.value, a.rate, b.rate)};
}
template <class T>
bool any_positive(const Dual<T>& a) {
  return any_positive(a.value);
}
template <class T>
Dual<T> max(const Dual<T>& a, const Dual<T>& b) {
  return where_positive(a - b, a, b);
}
template <class T>
Dual<T> abs(const Dual<T>& a) {
  return where_positive(a, a, -a);
}

// Returns matrix A with derivative dA.
template <class T>
Mat3<Dual<T>> dual_matrix(const Mat3<T>& A, const Mat3<T>& dA) {
  Mat3<Dual<T>> B;
  for (int i = 0; i < 9; ++i) B.a[i] = {A.a[i], dA.a[i]};
  return B;
}
template <class T>
Mat3<Dual<T>> constant_matrix(const Mat3<T>& A) {
  Mat3<Dual<T>> B;
  for (int i = 0; i < 9; ++i) B.a[i] = Dual<T>(A.a[i]);
  return B;
}
template <class T>
Mat3<T> values(const Mat3<Dual<T>>& A) {
  Mat3<T> B;
  for (int i = 0; i < 9; ++i) B.a[i] = A.a[i].value;
  return B;
}
template <class T>
Mat3<T> rates(const Mat3<Dual<T>>& A) {
  Mat3<T> B;
  for (int i = 0; i < 9; ++i) B.a[i] = A.a[i].rate;
  return B;
}

}  // namespace aspic
