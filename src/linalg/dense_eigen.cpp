#include "linalg/dense_eigen.h"

#include <Eigen/Eigenvalues>

#include "base/check.h"

namespace aspic {

DenseEigen dense_eigen(int n, std::span<const double> A) {
  ASPIC_CHECK(A.size() == static_cast<size_t>(n) * n);
  if (n == 0) return {};
  const Eigen::Map<const Eigen::MatrixXd> matrix(A.data(), n, n);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  ASPIC_CHECK(solver.info() == Eigen::Success);
  DenseEigen e;
  e.values.resize(n);
  e.vectors.resize(A.size());
  Eigen::Map<Eigen::VectorXd>(e.values.data(), n) = solver.eigenvalues().reverse();
  Eigen::Map<Eigen::MatrixXd>(e.vectors.data(), n, n) = solver.eigenvectors().rowwise().reverse();
  return e;
}

}  // namespace aspic
