// Positive semidefinite 9x9 matrices: a fast test of many matrices, and an eigenvalue filter for those that fail it.
#pragma once
#include <algorithm>
#include <array>
#include <limits>

#include "math/pack.h"
#include "math/small.h"
#include "math/symmetric_eigen.h"

namespace aspic {

// Sets bit l if H of lane l has an eigenvalue below -tolerance * (largest diagonal entry), or NaN. Tests whether H +
// shift Id = L D L' has positive D. Accurate to about 1e-15 relative.
template <class T>
unsigned indefinite_lanes(const Mat9<T>& H, double tolerance = 1e-12) {
  T scale = T(0.0);
  for (int i = 0; i < 9; ++i) scale = max(scale, abs(H(i, i)));
  const T shift = T(tolerance) * scale + T(std::numeric_limits<double>::min());  // H = 0 is semidefinite

  T L[9][9];  // below the diagonal, L; each column is scaled by D until it is finished
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

// Smallest eigenvalue after filtering, relative to the largest |eigenvalue|.
inline constexpr double kEigenvalueFloor = 1e-9;

// Replacement of an eigenvalue l: max(l, floor) or max(|l|, floor).
enum class EigenvalueFilter { clamp, absolute };

// Filters the eigenvalues of H in those of the given `lanes` that fail indefinite_lanes(), with floor = relative_floor
// * (largest |eigenvalue|). Other lanes are unchanged. `eigen()` must return eigenvalues and eigenvectors of H. Returns
// the filtered lanes.
template <class T, class Eigen>
unsigned filter_eigenvalues(Mat9<T>& H, EigenvalueFilter filter, unsigned lanes, const Eigen& eigen,
                            double relative_floor = kEigenvalueFloor) {
  const unsigned failed = indefinite_lanes(H) & lanes;
  if (failed == 0) return failed;
  const SymmetricEigen<9, T> e = eigen();
  T largest = T(0.0);
  for (const T& l : e.values) largest = max(largest, abs(l));
  const T floor = max(T(relative_floor) * largest, T(std::numeric_limits<double>::min()));
  const T chosen = lanes_from_bits<T>(failed);
  // Adds only the changes, so that other eigenvalues keep their last digits.
  for (int k = 0; k < 9; ++k) {
    const T l = e.values[k];
    const T raise = chosen * (max(filter == EigenvalueFilter::absolute ? abs(l) : l, floor) - l);
    if (!any_positive(raise)) continue;
    for (int c = 0; c < 9; ++c) {
      const T x = raise * e.vectors[9 * k + c];
      for (int r = 0; r < 9; ++r) H(r, c) = H(r, c) + x * e.vectors[9 * k + r];
    }
  }
  return failed;
}
template <class T>
unsigned modify_hessian(Mat9<T>& H, EigenvalueFilter filter, unsigned lanes = ~0U,
                        double relative_floor = kEigenvalueFloor) {
  const auto eigen = [&H] {
    std::array<T, 81> entries;
    std::copy(H.a, H.a + 81, entries.begin());
    return symmetric_eigen<9>(entries);
  };
  return filter_eigenvalues(H, filter, lanes, eigen, relative_floor);
}

}  // namespace aspic
