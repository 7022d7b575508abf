// Functions of symmetric 3x3 matrices over any scalar. Only rational operations: dual numbers and jets yield exact
// derivatives, also at equal eigenvalues.
#pragma once
#include "math/small.h"

namespace aspic {

// By the iteration of Denman and Beavers [Higham 2008, sec. 6.3], which doubles the number of digits in each step.
template <class T>
Mat3<T> square_root(const Mat3<T>& A) {
  Mat3<T> Y = A, Z = identity3<T>();
  for (int step = 0; step < 12; ++step) {
    const Mat3<T> next = T(0.5) * (Y + inverse(Z));
    Z = T(0.5) * (Z + inverse(Y));
    Y = next;
  }
  return Y;
}

// ln A = 2^5 ln A^(1/2^5), by the series 2 artanh X = 2 (X + X^3/3 + ...), X = (A - I) (A + I)^-1.
template <class T>
Mat3<T> matrix_log(Mat3<T> A) {
  constexpr int kRoots = 5, kLast = 21;
  for (int i = 0; i < kRoots; ++i) A = square_root(A);
  const Mat3<T> I = identity3<T>(), X = (A - I) * inverse(A + I), XX = X * X;
  Mat3<T> sum = T(1.0 / kLast) * I;
  for (int odd = kLast - 2; odd > 0; odd -= 2) sum = T(1.0 / odd) * I + XX * sum;
  return T(2.0 * (1 << kRoots)) * (X * sum);
}

// (exp(a E) - I) / a and (exp(a E) - I - a E) / a^2, also for a = 0.
template <class T>
struct ExpRemainders {
  Mat3<T> first, second;
};

// By the Taylor series for E/2^6. With exp(2 a E) = exp(a E)^2, the remainders of 2 E are 2 first + a first^2 and 2
// second + first^2.
template <class T>
ExpRemainders<T> exp_remainders(const T& a, const Mat3<T>& E) {
  constexpr int kSquarings = 6, kTerms = 16;
  const Mat3<T> I = identity3<T>(), X = T(1.0 / (1 << kSquarings)) * E, aX = a * X;
  Mat3<T> sum = I;
  for (int k = kTerms; k > 2; --k) sum = I + T(1.0 / k) * (aX * sum);
  ExpRemainders<T> r;
  r.second = T(0.5) * (X * X * sum);
  r.first = X + a * r.second;
  for (int i = 0; i < kSquarings; ++i) {
    const Mat3<T> square = r.first * r.first;
    r.second = T(2.0) * r.second + square;
    r.first = T(2.0) * r.first + a * square;
  }
  return r;
}

}  // namespace aspic
