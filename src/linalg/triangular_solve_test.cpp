#include "linalg/triangular_solve.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "linalg/matrices_test.h"

namespace aspic {
namespace {

struct Size {
  int rows, columns;
};

class TriangularSolve : public testing::TestWithParam<Size> {};

// Sizes around the block sizes of the kernels, and large enough to be shared by threads.
INSTANTIATE_TEST_SUITE_P(Sizes, TriangularSolve,
                         testing::Values(Size{3, 3}, Size{6, 3}, Size{15, 9}, Size{48, 48}, Size{99, 51},
                                         Size{300, 297}, Size{1200, 150}),
                         [](const auto& instance) {
                           return std::to_string(instance.param.rows) + "x" + std::to_string(instance.param.columns);
                         });

TEST_P(TriangularSolve, AgreesWithDenseAlgebra) {
  const auto [rows, columns] = GetParam();
  std::vector<double> entries = test::random_vector(static_cast<size_t>(rows) * columns, 1);
  for (int j = 0; j < columns; ++j) entries[j + static_cast<size_t>(j) * rows] = 2.0 * columns;  // well conditioned
  const Eigen::Map<const Eigen::MatrixXd> L(entries.data(), rows, columns);
  const auto L11 = L.topRows(columns).triangularView<Eigen::Lower>();
  const Eigen::MatrixXd L21 = L.bottomRows(rows - columns);
  const std::vector<double> v = test::random_vector(rows, 2);
  const Eigen::Map<const Eigen::VectorXd> x0(v.data(), columns), y0(v.data() + columns, rows - columns);

  Eigen::VectorXd x = x0, y = y0;
  solve_forward(entries.data(), rows, columns, x.data(), y.data());
  const Eigen::VectorXd expected = L11.solve(x0);
  const double round_off = 1e-15 * rows;
  EXPECT_LE((x - expected).norm(), round_off * expected.norm());
  EXPECT_LE((y - (y0 - L21 * expected)).norm(), round_off * (1 + y0.norm()));

  x = x0, y = y0;
  solve_backward(entries.data(), rows, columns, x.data(), y.data());
  const Eigen::VectorXd transposed = L11.transpose().solve(x0 - L21.transpose() * y0);
  EXPECT_LE((x - transposed).norm(), round_off * (1 + transposed.norm()));
  EXPECT_EQ(y, y0);
}

}  // namespace
}  // namespace aspic
