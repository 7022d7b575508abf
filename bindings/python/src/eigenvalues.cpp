#include "eigenvalues.h"

#include <algorithm>
#include <cmath>

#include "linalg/dense_eigen.h"

namespace aspic::python {

bool modify_eigenvalues(int n, std::vector<double>& A, Definiteness kind) {
  constexpr double kSmallest = 1e-10;  // smallest eigenvalue, relative to the largest size of one
  if (kind == Definiteness::exact) return false;
  const DenseEigen eigen = dense_eigen(n, A);
  if (eigen.values.back() >= 0) return false;
  const double smallest = kSmallest * std::max(std::abs(eigen.values.front()), std::abs(eigen.values.back()));
  std::fill(A.begin(), A.end(), 0.0);
  for (int k = 0; k < n; ++k) {
    const double given = eigen.values[k];
    const double value = std::max(kind == Definiteness::absolute ? std::abs(given) : given, smallest);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) A[i + j * n] += value * eigen.vectors[i + k * n] * eigen.vectors[j + k * n];
  }
  return true;
}

}  // namespace aspic::python
