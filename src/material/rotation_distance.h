// mu |F - R|^2, where R is the rotation closest to F: the term shared by arap and corotated.
//   P = 2 mu (F - R),  H = 2 mu (Id - dR/dF)
#pragma once
#include "math/polar3.h"

namespace aspic {

// Lower bound of s_i + s_j [1]; dR/dF grows like 1 / (s_i + s_j), and the bound keeps H finite.
inline constexpr double kMinStretchSum = 1e-8;

// |F - R|^2 = |F|^2 - 2 tr S + 3, or the better conditioned sum of (s_i - 1)^2 if the s_i are available.
template <class T>
T squared_rotation_distance(const Mat3<T>& F) {
  const Svd3<T> f = svd3(F);
  const T x = f.s[0] - T(1.0), y = f.s[1] - T(1.0), z = f.s[2] - T(1.0);
  return x * x + y * y + z * z;
}
template <class T>
Jet<T> squared_rotation_distance(const Mat3<Jet<T>>& F) {
  return squared_norm(F) - 2.0 * stretch_trace(F) + 3.0;
}

}  // namespace aspic
