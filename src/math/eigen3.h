// Eigenvalues and eigenvectors of a symmetric 3x3 matrix.
#pragma once
#include <algorithm>

#include "math/small.h"
#include "math/symmetric_eigen.h"

namespace aspic {

struct Eigen3 {
  Vec3d values;   // ascending
  Mat3d vectors;  // orthonormal columns, in the order of the values
};

// A must be symmetric and finite.
inline Eigen3 symmetric_eigen(const Mat3d& A) {
  std::array<double, 9> entries;
  std::copy(A.a, A.a + 9, entries.begin());
  const SymmetricEigen<3> e = symmetric_eigen<3>(entries);
  Eigen3 result;
  std::copy(e.values.begin(), e.values.end(), result.values.a);
  std::copy(e.vectors.begin(), e.vectors.end(), result.vectors.a);
  return result;
}

}  // namespace aspic
