// Eigenvalues and eigenvectors of dense symmetric matrices of a few hundred rows.
#pragma once
#include <span>
#include <vector>

namespace aspic {

// A = sum over k of values[k] v_k v_k'. The values descend; v_k is column k of `vectors` (column-major, orthonormal).
struct DenseEigen {
  std::vector<double> values, vectors;
};

// `A`: n x n; only the lower triangle is read. Its entries must be finite.
DenseEigen dense_eigen(int n, std::span<const double> A);

}  // namespace aspic
