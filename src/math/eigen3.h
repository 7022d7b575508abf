// Eigenvalues and eigenvectors of a symmetric 3x3 matrix.
#pragma once
#include "math/small.h"

namespace aspic {

struct Eigen3 {
  Vec3d values;   // ascending
  Mat3d vectors;  // orthonormal columns in the order of the values
};

// Requires that A is symmetric and finite.
Eigen3 symmetric_eigen(const Mat3d& A);

}  // namespace aspic
