// Singular values of 3x3 matrices with proper rotations on both sides, by one-sided Jacobi [Golub 2013, sec. 8.6].
#pragma once
#include "math/pack.h"
#include "math/small.h"

namespace aspic {

// F = U diag(s) V' with det U = det V = +1 and s[0] >= s[1] >= |s[2]|: s[2] has the sign of det F.
// Hence s[i] + s[j] >= 0 (up to rounding), and R = U V' is the rotation closest to F.
template <class T>
struct Svd3 {
  Mat3<T> U;
  Vec3<T> s;
  Mat3<T> V;
};

// Requires a finite F. F = 0 gives U = V = I.
Svd3<double> svd3(const Mat3d& F);
Svd3<Pack> svd3(const Mat3<Pack>& F);

}  // namespace aspic
