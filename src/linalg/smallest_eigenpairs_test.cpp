#include "linalg/smallest_eigenpairs.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace aspic {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// K and M as dense matrices; the first `held` entries of admissible vectors are zero.
ShiftedPencil pencil_of(const MatrixXd& K, const MatrixXd& M, double shift, int held = 0) {
  const int n = static_cast<int>(K.rows());
  const auto vector = [n](auto x) { return Eigen::Map<const VectorXd>(x.data(), n); };
  MatrixXd A = K + shift * M;
  A.topRows(held).setZero();
  A.leftCols(held).setZero();
  A.topLeftCorner(held, held).setIdentity();
  const Eigen::LLT<MatrixXd> factor(A);
  return {.size = n,
          .dimension = n - held,
          .shift = shift,
          .project = [held](std::span<double> x) { std::fill(x.begin(), x.begin() + held, 0.0); },
          .multiply_mass = [=](std::span<const double> x,
                               std::span<double> y) { Eigen::Map<VectorXd>(y.data(), n) = M * vector(x); },
          .solve = [=](std::span<const double> b,
                       std::span<double> x) { Eigen::Map<VectorXd>(x.data(), n) = factor.solve(vector(b)); }};
}

MatrixXd chain(int n) {  // stiffness of a chain of springs with free ends
  MatrixXd K = MatrixXd::Zero(n, n);
  for (int i = 0; i + 1 < n; ++i) K.block<2, 2>(i, i) += (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
  return K;
}

MatrixXd masses(int n) {
  VectorXd m(n);
  for (int i = 0; i < n; ++i) m[i] = 1 + 0.5 * std::sin(i);
  return m.asDiagonal();
}

void expect_dense_solution(const Eigenpairs& found, const MatrixXd& K, const MatrixXd& M, int count) {
  const VectorXd expected = Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M).eigenvalues();
  ASSERT_TRUE(found.converged);
  ASSERT_EQ(found.values.size(), static_cast<size_t>(count));
  for (int k = 0; k < count; ++k) {
    EXPECT_NEAR(found.values[k], expected[k], 1e-9 * expected[count - 1]) << k;
    const Eigen::Map<const VectorXd> u(found.vectors[k].data(), K.rows());
    EXPECT_LT((K * u - found.values[k] * M * u).norm(), 1e-8 * (M * u).norm()) << k;
    EXPECT_NEAR(u.dot(M * u), 1, 1e-12) << k;
  }
}

TEST(SmallestEigenpairs, AgreeWithDenseSolver) {
  const MatrixXd K = chain(300), M = masses(300);
  expect_dense_solution(smallest_eigenpairs(pencil_of(K, M, 1e-4), 8), K, M, 8);
}

TEST(SmallestEigenpairs, UseDenseSolverInSmallSubspaces) {
  const MatrixXd K = chain(9), M = masses(9);
  const Eigenpairs held = smallest_eigenpairs(pencil_of(K, M, 1e-4, 4), 20);
  ASSERT_EQ(held.values.size(), 5u);  // all that exist
  const VectorXd expected =
      Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K.bottomRightCorner(5, 5), M.bottomRightCorner(5, 5))
          .eigenvalues();
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(held.values[k], expected[k], 1e-10) << k;
  EXPECT_EQ(held.vectors[0][3], 0);
}

// A Krylov space contains one vector of each eigenspace.
TEST(SmallestEigenpairs, FindEveryCopyOfRepeatedValues) {
  const int n = 400;
  VectorXd values(n);
  for (int i = 0; i < n; ++i) values[i] = i < 6 ? 0 : i < 9 ? 1 : 2 + i / 2;
  const Eigenpairs found = smallest_eigenpairs(pencil_of(values.asDiagonal(), MatrixXd::Identity(n, n), 1e-2), 12);
  ASSERT_TRUE(found.converged);
  for (int k = 0; k < 12; ++k) EXPECT_NEAR(found.values[k], values[k], 1e-9) << k;
}

TEST(SmallestEigenpairs, DoNotDependOnUnits) {
  const MatrixXd K = chain(200), M = masses(200);
  const Eigenpairs one = smallest_eigenpairs(pencil_of(K, M, 1e-4), 5);
  const Eigenpairs other = smallest_eigenpairs(pencil_of(1e12 * K, 1e-9 * M, 1e17), 5);
  ASSERT_TRUE(other.converged);
  for (int k = 1; k < 5; ++k) EXPECT_NEAR(other.values[k] / one.values[k], 1e21, 1e12) << k;
}

TEST(SmallestEigenpairs, AreBitReproducible) {
  const ShiftedPencil pencil = pencil_of(chain(200), masses(200), 1e-4);
  const Eigenpairs one = smallest_eigenpairs(pencil, 5), other = smallest_eigenpairs(pencil, 5);
  EXPECT_EQ(one.values, other.values);
  EXPECT_EQ(one.vectors, other.vectors);
}

}  // namespace
}  // namespace aspic
