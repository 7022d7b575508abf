#include "model/scaled_inverse.h"

#include <algorithm>
#include <cmath>

#include "linalg/dense_eigen.h"

namespace aspic {

ScaledInverse scaled_inverse(int n, std::span<const double> A, double floor, Weak weak) {
  constexpr double kTakesPart = 0.1;  // absolute entry of a unit eigenvector: 1 % of its square
  std::vector<int> kept;
  std::vector<double> scale(n, 0.0);
  for (int i = 0; i < n; ++i)
    if (const double a = A[static_cast<size_t>(n) * i + i]; a > 0) kept.push_back(i), scale[i] = std::sqrt(a);
  const int m = static_cast<int>(kept.size());
  ScaledInverse result{std::vector<double>(static_cast<size_t>(n) * n, 0.0), std::vector<double>(n, 0.0)};
  if (m == 0) return result;
  std::vector<double> C(static_cast<size_t>(m) * m);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i)
      C[static_cast<size_t>(m) * j + i] =
          A[static_cast<size_t>(n) * kept[j] + kept[i]] / (scale[kept[i]] * scale[kept[j]]);
  const DenseEigen eigen = dense_eigen(m, C);
  for (int i = 0; i < m; ++i) result.weakest[kept[i]] = 1;
  for (int k = 0; k < m; ++k) {
    const double* v = eigen.vectors.data() + static_cast<size_t>(m) * k;
    const bool is_weak = !(eigen.values[k] > floor);
    const double inverse = is_weak ? (weak == Weak::dropped ? 0 : 1 / floor) : 1 / eigen.values[k];
    for (int i = 0; i < m; ++i) {
      if (std::abs(v[i]) > kTakesPart) result.weakest[kept[i]] = std::min(result.weakest[kept[i]], eigen.values[k]);
      for (int j = 0; j < m; ++j)
        result.inverse[static_cast<size_t>(n) * kept[i] + kept[j]] +=
            v[i] * v[j] * inverse / (scale[kept[i]] * scale[kept[j]]);
    }
  }
  return result;
}

}  // namespace aspic
