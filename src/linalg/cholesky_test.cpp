#include "linalg/cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include "base/parallel.h"
#include "linalg/matrices_test.h"
#include "linalg/ordering.h"

namespace aspic {
namespace {

using namespace test;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Factorizes, solves and compares with Eigen's dense Cholesky. Both errors are bounded by n eps cond(H); the condition
// numbers here are below 1e5.
void expect_dense_solution(const Matrix& H, unsigned seed) {
  const int n = 3 * H.rows();
  const std::vector<double> b = random_vector(n, seed);
  std::vector<double> x(n);
  Cholesky solver;
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  const SolveReport report = solver.solve(b, x, 1e-12);
  EXPECT_TRUE(report.ok);
  EXPECT_LE(report.relative_residual, 1e-12);
  if (n == 0) return;
  const std::vector<double> entries = dense(H.values);
  const Eigen::Map<const Eigen::MatrixXd> A(entries.data(), n, n);
  const Eigen::Map<const Eigen::VectorXd> B(b.data(), n), X(x.data(), n);
  const Eigen::VectorXd expected = A.llt().solve(B);
  EXPECT_LE((X - expected).norm(), n * kEpsilon * 1e5 * expected.norm());
}

TEST(Cholesky, AgreesWithDenseOnRandomMatrices) {
  for (const int rows : {1, 2, 3, 4, 5, 7, 12, 40, 199, 200, 350})
    for (const int per_row : {0, 1, 4}) {
      SCOPED_TRACE(testing::Message() << rows << " rows, " << per_row << " couplings per row");
      expect_dense_solution(random_dominant(rows, random_couplings(rows, per_row * rows, 1), 2), 3);
    }
}

TEST(Cholesky, AgreesWithDenseOnFullMatrices) {
  for (const int rows : {3, 30, 90, 210}) {
    Couplings all;
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < i; ++j) all.emplace_back(i, j);
    expect_dense_solution(random_dominant(rows, all, 4), 5);
  }
}

TEST(Cholesky, AgreesWithDenseOnArrowMatrices) {
  for (const int head : {0, 150, 299}) {  // every row is coupled with `head`
    Couplings arrow;
    for (int i = 0; i < 300; ++i) arrow.emplace_back(i, head);
    expect_dense_solution(random_dominant(300, arrow, 6), 7);
  }
}

TEST(Cholesky, AgreesWithDenseOnDisconnectedGraphs) {
  Couplings couplings;
  for (int i = 0; i + 3 < 400; i += 4) couplings.emplace_back(i, i + 2), couplings.emplace_back(i + 2, i + 3);
  expect_dense_solution(random_dominant(400, couplings, 8), 9);
}

TEST(Cholesky, AgreesWithDenseOnLattice) {
  expect_dense_solution(spring_lattice({.nx = 9, .ny = 5, .nz = 4, .stiffness = 100}), 10);
}

TEST(Cholesky, SolvesEmptySystem) {
  const Matrix H = random_dominant(0, {}, 1);
  Cholesky solver;
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  EXPECT_TRUE(solver.solve({}, {}, 1e-10).ok);
}

TEST(Cholesky, ResidualIsRoundOffOnStiffLattice) {
  // Large enough for the packed kernels: the widest separator has about 15 x 15 vertices.
  const Matrix H = spring_lattice({.nx = 28, .ny = 14, .nz = 14, .stiffness = 1e4});
  const std::vector<double> b = random_vector(3 * H.rows(), 11);
  std::vector<double> x(b.size());
  Cholesky solver;
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  EXPECT_TRUE(solver.solve(b, x, 0.0).ok);  // a tolerance of 0 requests the round-off level
  EXPECT_LE(relative_residual(H.values, b, x), 1e-11);
}

TEST(Cholesky, IsReusableAfterFailures) {
  Matrix H = spring_lattice({.nx = 6, .ny = 5, .nz = 5, .stiffness = 10});
  const std::vector<double> b = random_vector(3 * H.rows(), 12);
  std::vector<double> x(b.size());
  Cholesky solver;
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  for (const double shift : {-2.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const LargeVector<Mat3d> saved = H.values.block;
    add_block(H.values, 100, 100, (shift * 100) * identity3<double>());
    EXPECT_FALSE(solver.factorize(H.values));
    EXPECT_FALSE(solver.refused());
    H.values.block = saved;
    add_block(H.values, 3, 3, identity3<double>());
    ASSERT_TRUE(solver.factorize(H.values));
    EXPECT_TRUE(solver.solve(b, x, 1e-10).ok);
    EXPECT_LE(relative_residual(H.values, b, x), 1e-10);
  }
}

TEST(Cholesky, DetectsSignOfSmallestEigenvalue) {
  // Springs do not resist rigid motions, so the smallest eigenvalue is exactly the mass term.
  for (const double mass : {1e-3, -1e-3}) {
    const Matrix H = spring_lattice({.nx = 6, .ny = 6, .nz = 6, .mass = mass});
    Cholesky solver;
    solver.analyze(*H.pattern);
    EXPECT_EQ(solver.factorize(H.values), mass > 0);
  }
}

TEST(Cholesky, RejectsSingularMatrix) {
  const Matrix H = spring_lattice({.nx = 6, .ny = 6, .nz = 6, .mass = 0});
  Cholesky solver;
  solver.analyze(*H.pattern);
  EXPECT_FALSE(solver.factorize(H.values));
}

TEST(Cholesky, RejectsFactorThatDoesNotFit) {
  const Matrix H = spring_lattice({.nx = 8, .ny = 8, .nz = 8});
  Cholesky tight(100'000);
  tight.analyze(*H.pattern);
  ASSERT_GT(tight.analysis().bytes, 100'000);
  EXPECT_FALSE(tight.factorize(H.values));
  EXPECT_TRUE(tight.refused());
  EXPECT_NE(tight.description().find("are free"), std::string::npos);
  Cholesky roomy(tight.analysis().bytes);
  roomy.analyze(*H.pattern);
  EXPECT_TRUE(roomy.factorize(H.values));
  EXPECT_FALSE(roomy.refused());
}

TEST(Cholesky, CostOfFullMatrixMatchesDenseCholesky) {
  constexpr int kRows = 60, kSize = 3 * kRows;
  Couplings all;
  for (int i = 0; i < kRows; ++i)
    for (int j = 0; j < i; ++j) all.emplace_back(i, j);
  const Supernodes s = find_supernodes(make_pattern(kRows, all), minimum_degree_order(make_pattern(kRows, all)));
  EXPECT_EQ(s.count(), 1);
  EXPECT_EQ(s.cost.nnz, kSize * kSize);
  EXPECT_DOUBLE_EQ(s.cost.flops, kSize * (kSize + 1.0) * (2.0 * kSize + 1) / 6);  // sum of squares
}

TEST(Cholesky, IsBitReproducibleForAnyThreadCount) {
  const Matrix H = spring_lattice({.nx = 20, .ny = 9, .nz = 9, .stiffness = 1e3});
  const std::vector<double> b = random_vector(3 * H.rows(), 13);
  const int threads = thread_count();
  std::vector<double> expected;
  for (const int count : {1, 2, 3, 8}) {
    set_thread_count(count);
    Cholesky solver;
    solver.analyze(*H.pattern);
    ASSERT_TRUE(solver.factorize(H.values));
    std::vector<double> x(b.size());
    EXPECT_TRUE(solver.solve(b, x, 1e-10).ok);
    if (expected.empty()) expected = x;
    EXPECT_EQ(x, expected) << count << " threads";
  }
  set_thread_count(threads);
}

TEST(Cholesky, DetectsNegativePivotsForAnyThreadCount) {
  Matrix H = spring_lattice({.nx = 16, .ny = 8, .nz = 8, .stiffness = 10});
  const int threads = thread_count();
  for (const int count : {1, 2, 3, 8}) {
    set_thread_count(count);
    Cholesky solver;
    solver.analyze(*H.pattern);
    for (int row = 0; row < H.rows(); row += 97) {
      Mat3d& D = H.values.block[H.pattern->diagonal(row)];
      const Mat3d before = D;
      D = -1.0 * D;
      EXPECT_FALSE(solver.factorize(H.values)) << "row " << row;
      D = before;
    }
    EXPECT_TRUE(solver.factorize(H.values));
  }
  set_thread_count(threads);
}

TEST(Cholesky, CountsProducts) {
  const Matrix H = spring_lattice({.nx = 4, .ny = 4, .nz = 4});
  const std::vector<double> b = random_vector(3 * H.rows(), 14);
  std::vector<double> x(b.size());
  Cholesky solver;
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  EXPECT_EQ(solver.solve(b, x, 1e-8).products, 1);
  EXPECT_EQ(solver.solve(b, x, 0).products, 2);  // one refinement
}

TEST(Ordering, IsPermutationWithLittleFill) {
  const Matrix H = spring_lattice({.nx = 12, .ny = 12, .nz = 12});
  std::vector<int> natural(H.rows());
  for (int i = 0; i < H.rows(); ++i) natural[i] = i;
  const double natural_flops = find_supernodes(*H.pattern, natural).cost.flops;
  for (std::vector<int> order :
       {fill_reducing_order(*H.pattern), minimum_degree_order(*H.pattern), geometric_order(*H.pattern)}) {
    const double flops = find_supernodes(*H.pattern, order).cost.flops;
    EXPECT_LT(flops, natural_flops / 2);
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, natural);
  }
}

TEST(Ordering, GeometricDissectionHasLessFillThanMinimumDegree) {
  const Matrix H = spring_lattice({.nx = 18, .ny = 18, .nz = 18});
  const auto flops_of = [&](const std::vector<int>& order) { return find_supernodes(*H.pattern, order).cost.flops; };
  const double geometric = flops_of(geometric_order(*H.pattern));
  EXPECT_LT(geometric, 0.75 * flops_of(minimum_degree_order(*H.pattern)));
  EXPECT_LT(geometric, 1.25 * flops_of(fill_reducing_order(*H.pattern)));
}

// Pinned vertices have no couplings; coincident vertices cannot be separated by a plane.
TEST(Ordering, GeometricDissectionAcceptsDegeneratePositions) {
  Matrix H = spring_lattice({.nx = 6, .ny = 6, .nz = 6});
  for (Vec3d& x : H.pattern->rest_position) x = {};
  std::vector<int> order = geometric_order(*H.pattern);
  std::sort(order.begin(), order.end());
  for (int i = 0; i < H.rows(); ++i) ASSERT_EQ(order[i], i);
}

}  // namespace
}  // namespace aspic
