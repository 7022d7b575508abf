// Second-order forward automatic differentiation in the 9 entries of a 3x3 matrix. T is double or Pack.
#pragma once
#include <concepts>

#include "math/pack.h"
#include "math/small.h"

namespace aspic {

// A function value with its first and second derivatives. Stores the lower triangle of the Hessian.
template <class T>
struct Jet {
  static constexpr int kVariables = 9;
  static constexpr int kTriangle = kVariables * (kVariables + 1) / 2;
  static constexpr int triangle(int i, int j) { return i * (i + 1) / 2 + j; }  // j <= i

  T value;
  T gradient[kVariables];
  T hessian[kTriangle];

  Jet() = default;
  Jet(double constant) : Jet(Constant{}, T(constant)) {}
  explicit Jet(const T& constant) requires(!std::same_as<T, double>) : Jet(Constant{}, constant) {}
  static Jet variable(const T& x, int i) {
    Jet f(Constant{}, x);
    f.gradient[i] = T(1.0);
    return f;
  }

  // Returns g(a) for a function g of one variable, given g, g' and g'' at the value of a.
  friend Jet compose(const Jet& a, const T& g, const T& dg, const T& ddg) {
    Jet f;
    f.value = g;
    for (int i = 0; i < kVariables; ++i) {
      f.gradient[i] = dg * a.gradient[i];
      for (int j = 0; j <= i; ++j)
        f.hessian[triangle(i, j)] = dg * a.hessian[triangle(i, j)] + ddg * a.gradient[i] * a.gradient[j];
    }
    return f;
  }

  friend Jet operator+(const Jet& a, const Jet& b) {
    return combine(a, b, [](const T& x, const T& y) { return x + y; });
  }
  friend Jet operator-(const Jet& a, const Jet& b) {
    return combine(a, b, [](const T& x, const T& y) { return x - y; });
  }
  friend Jet operator-(const Jet& a) { return scaled(a, -1); }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet f;
    f.value = a.value * b.value;
    for (int i = 0; i < kVariables; ++i) {
      f.gradient[i] = a.value * b.gradient[i] + b.value * a.gradient[i];
      for (int j = 0; j <= i; ++j) {
        const int k = triangle(i, j);
        f.hessian[k] = a.value * b.hessian[k] + b.value * a.hessian[k] +
                       (a.gradient[i] * b.gradient[j] + b.gradient[i] * a.gradient[j]);
      }
    }
    return f;
  }
  friend Jet operator/(const Jet& a, const Jet& b) { return a * reciprocal(b); }

  // Operations with constants, whose derivatives are zero.
  friend Jet operator*(double s, const Jet& a) { return scaled(a, s); }
  friend Jet operator*(const Jet& a, double s) { return scaled(a, s); }
  friend Jet operator/(const Jet& a, double s) { return scaled(a, 1 / s); }
  friend Jet operator/(double s, const Jet& a) { return scaled(reciprocal(a), s); }
  friend Jet operator+(const Jet& a, double s) { return shifted(a, s); }
  friend Jet operator+(double s, const Jet& a) { return shifted(a, s); }
  friend Jet operator-(const Jet& a, double s) { return shifted(a, -s); }
  friend Jet operator-(double s, const Jet& a) { return shifted(-a, s); }

  Jet& operator+=(const Jet& b) { return *this = *this + b; }
  Jet& operator-=(const Jet& b) { return *this = *this - b; }
  Jet& operator*=(const Jet& b) { return *this = *this * b; }

 private:
  struct Constant {};
  Jet(Constant, const T& x) : value(x) {
    for (T& g : gradient) g = T(0.0);
    for (T& h : hessian) h = T(0.0);
  }

  template <class Fn>
  static Jet combine(const Jet& a, const Jet& b, Fn fn) {
    Jet f;
    f.value = fn(a.value, b.value);
    for (int i = 0; i < kVariables; ++i) f.gradient[i] = fn(a.gradient[i], b.gradient[i]);
    for (int k = 0; k < kTriangle; ++k) f.hessian[k] = fn(a.hessian[k], b.hessian[k]);
    return f;
  }
  static Jet shifted(Jet a, double s) {
    a.value = a.value + T(s);
    return a;
  }
  static Jet scaled(const Jet& a, double s) {
    Jet f;
    f.value = T(s) * a.value;
    for (int i = 0; i < kVariables; ++i) f.gradient[i] = T(s) * a.gradient[i];
    for (int k = 0; k < kTriangle; ++k) f.hessian[k] = T(s) * a.hessian[k];
    return f;
  }
  static Jet reciprocal(const Jet& a) {
    const T r = T(1.0) / a.value;
    return compose(a, r, -(r * r), T(2.0) * r * r * r);
  }
};

template <class T>
Jet<T> sqrt(const Jet<T>& a) {
  const T root = sqrt(a.value), slope = T(0.5) / root;
  return compose(a, root, slope, T(-0.5) * slope / a.value);
}
template <class T>
Jet<T> cbrt(const Jet<T>& a) {
  const T root = cbrt(a.value), slope = T(1.0) / (T(3.0) * root * root);
  return compose(a, root, slope, T(-2.0 / 3.0) * slope / a.value);
}
template <class T>
Jet<T> exp(const Jet<T>& a) {
  const T e = exp(a.value);
  return compose(a, e, e, e);
}
template <class T>
Jet<T> log(const Jet<T>& a) {
  const T r = T(1.0) / a.value;
  return compose(a, log(a.value), r, -(r * r));
}
// a^n for a constant n.
template <class T>
Jet<T> pow(const Jet<T>& a, double n) {
  const T power = pow(a.value, n - 2), slope = power * a.value;
  return compose(a, slope * a.value, T(n) * slope, T(n * (n - 1)) * power);
}

// The value selects the branch; the derivatives are those of the selected branch.
template <class T>
Jet<T> where_positive(const Jet<T>& condition, const Jet<T>& a, const Jet<T>& b) {
  Jet<T> f;
  f.value = where_positive(condition.value, a.value, b.value);
  for (int i = 0; i < Jet<T>::kVariables; ++i)
    f.gradient[i] = where_positive(condition.value, a.gradient[i], b.gradient[i]);
  for (int k = 0; k < Jet<T>::kTriangle; ++k)
    f.hessian[k] = where_positive(condition.value, a.hessian[k], b.hessian[k]);
  return f;
}

// Returns the entries of F as the 9 variables.
template <class T>
Mat3<Jet<T>> jet_variables(const Mat3<T>& F) {
  Mat3<Jet<T>> X;
  for (int i = 0; i < 9; ++i) X.a[i] = Jet<T>::variable(F.a[i], i);
  return X;
}
template <class T>
Mat3<T> gradient(const Jet<T>& f) {
  Mat3<T> P;
  for (int i = 0; i < 9; ++i) P.a[i] = f.gradient[i];
  return P;
}
template <class T>
Mat9<T> hessian(const Jet<T>& f) {
  Mat9<T> H;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j <= i; ++j) H(i, j) = H(j, i) = f.hessian[Jet<T>::triangle(i, j)];
  return H;
}

}  // namespace aspic
