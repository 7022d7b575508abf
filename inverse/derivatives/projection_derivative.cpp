#include "derivatives/projection_derivative.h"

#include <algorithm>

#include "math/definite.h"

namespace aspic {

SymmetricEigen<9, Pack> modified_product_derivative(const Mat9<Pack>& A, const Mat3<Pack>& u, const Mat3<Pack>& w,
                                                    Definiteness kind) {
  std::array<Pack, 81> entries;
  std::copy(A.a, A.a + 81, entries.begin());
  const SymmetricEigen<9, Pack> e = symmetric_eigen<9>(entries);
  const auto vector = [&e](int k) { return &e.vectors[9 * k]; };
  const auto along = [&](int k, const Mat3<Pack>& x) {
    Pack sum = 0.0;
    for (int i = 0; i < 9; ++i) sum += vector(k)[i] * x.a[i];
    return sum;
  };
  Pack largest = 0.0;
  for (const Pack& l : e.values) largest = max(largest, abs(l));
  const Pack floor = max(Pack(kEigenvalueFloor) * largest, Pack(std::numeric_limits<double>::min()));

  std::array<Pack, 9> f, slope, a, b;
  Pack raised = 0.0;  // sum of the changes of the threshold
  for (int k = 0; k < 9; ++k) {
    const Pack l = kind == Definiteness::absolute ? abs(e.values[k]) : e.values[k];
    f[k] = max(l, floor);
    slope[k] = where_positive(l - floor, where_positive(e.values[k], 1.0, -1.0), 0.0);
    a[k] = along(k, u), b[k] = along(k, w);
    raised += where_positive(l - floor, 0.0, a[k] * b[k]);
  }
  std::array<Pack, 81> S;
  S.fill(0.0);
  const auto add = [&](const Pack& s, const Pack* x, const Pack* y) {
    for (int c = 0; c < 9; ++c)
      for (int r = 0; r < 9; ++r) S[r + 9 * c] += s * x[r] * y[c];
  };
  for (int i = 0; i < 9; ++i) {
    add(slope[i] * a[i] * b[i], vector(i), vector(i));
    const Pack is_largest =
        where_positive(abs(e.values[i]) - largest, 0.0, 1.0) * where_positive(largest - abs(e.values[i]), 0.0, 1.0);
    add(raised * is_largest * Pack(kEigenvalueFloor) * where_positive(e.values[i], 1.0, -1.0), vector(i), vector(i));
    for (int j = 0; j < i; ++j) {
      const Pack alike = 0.5 - abs(slope[i] - slope[j]);
      const Pack gap = where_positive(alike, 1.0, e.values[i] - e.values[j]);
      const Pack rate = where_positive(alike, slope[i], (f[i] - f[j]) / gap);
      const Pack s = 0.5 * rate * (a[i] * b[j] + a[j] * b[i]);
      add(s, vector(i), vector(j));
      add(s, vector(j), vector(i));
    }
  }
  return symmetric_eigen<9>(S);
}

}  // namespace aspic
