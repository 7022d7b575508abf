// Eigenvalues and eigenvectors of a dense symmetric matrix of some hundred rows.
#pragma once
#include <span>
#include <vector>

namespace aspic {

// A = sum values[k] v_k v_k', values descending, v_k = column k of `vectors` (column-major), orthonormal.
struct DenseEigen {
  std::vector<double> values, vectors;
};

// `A`: n x n, of which the lower triangle is read; its entries must be finite.
DenseEigen dense_eigen(int n, std::span<const double> A);

}  // namespace aspic
