#include "math/eigen3.h"

#include <algorithm>

#include "math/symmetric_eigen.h"

namespace aspic {

template SymmetricEigen<3, double> symmetric_eigen<3, double>(std::array<double, 9> A);

Eigen3 symmetric_eigen(const Mat3d& A) {
  std::array<double, 9> entries;
  std::copy(A.a, A.a + 9, entries.begin());
  const SymmetricEigen<3> e = symmetric_eigen<3>(entries);
  int order[] = {0, 1, 2};
  std::sort(order, order + 3, [&e](int i, int j) { return e.values[i] < e.values[j]; });
  Eigen3 sorted;
  for (int k = 0; k < 3; ++k) {
    sorted.values[k] = e.values[order[k]];
    std::copy_n(&e.vectors[3 * order[k]], 3, &sorted.vectors.a[3 * k]);
  }
  return sorted;
}

}  // namespace aspic
