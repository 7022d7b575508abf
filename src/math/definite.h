// Positive semidefinite 9x9 matrices: a fast exact test for many at a time, and a filter for the few that fail.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "math/pack.h"
#include "math/small.h"
#include "math/symmetric_eigen.h"

namespace aspic {

// Bit l is set when H of lane l has an eigenvalue below -tolerance * (largest diagonal entry); NaN sets it too.
// The test is whether H + shift Id = L D L' has positive D. It is sharp up to rounding (about 1e-15 of the scale).
template <class T>
unsigned indefinite_lanes(const Mat9<T>& H, double tolerance = 1e-12) {
  T scale = T(0.0);
  for (int i = 0; i < 9; ++i) scale = max(scale, abs(H(i, i)));
  const T shift = T(tolerance) * scale + T(std::numeric_limits<double>::min());  // H = 0 is semidefinite

  T L[9][9];  // below the diagonal L; scaled by D before its column is finished
  unsigned failed = 0;
  for (int k = 0; k < 9; ++k) {
    T d = H(k, k) + shift;
    for (int m = 0; m < k; ++m) d = d - L[k][m] * L[k][m] * L[m][m];
    failed |= lanes_not_positive(d);
    L[k][k] = d;
    const T inverse = T(1.0) / d;
    for (int i = k + 1; i < 9; ++i) {
      T x = H(i, k);
      for (int m = 0; m < k; ++m) x = x - L[i][m] * (L[k][m] * L[m][m]);
      L[i][k] = x * inverse;
    }
  }
  return failed;
}

// What becomes of an eigenvalue l: max(l, floor) or max(|l|, floor).
enum class EigenvalueFilter { clamp, absolute };

// Filters the eigenvalues of the symmetric H, with floor = relative_floor * (largest |eigenvalue|).
inline void make_definite(Mat9d& H, EigenvalueFilter filter, double relative_floor = 1e-9) {
  std::array<double, 81> entries;
  std::copy(H.a, H.a + 81, entries.begin());
  const SymmetricEigen<9> e = symmetric_eigen<9>(entries);
  const double largest = std::fmax(std::abs(e.values.front()), std::abs(e.values.back()));
  const double floor = std::fmax(relative_floor * largest, std::numeric_limits<double>::min());
  // Only what the filter changes is added, so that the other eigenvalues keep their last digits.
  for (int k = 0; k < 9 && e.values[k] < floor; ++k) {
    const double kept = filter == EigenvalueFilter::absolute ? std::abs(e.values[k]) : e.values[k];
    const double raise = std::fmax(kept, floor) - e.values[k];
    const double* v = &e.vectors[9 * k];
    for (int c = 0; c < 9; ++c)
      for (int r = 0; r < 9; ++r) H(r, c) += raise * (v[r] * v[c]);
  }
}

}  // namespace aspic
