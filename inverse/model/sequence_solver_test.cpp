#include "model/sequence_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "linalg/matrices_test.h"

namespace aspic {
namespace {

using namespace test;

double relative_residual(const BlockSparse& H, std::span<const double> b, std::span<const double> x) {
  std::vector<double> Hx(b.size());
  H.multiply(x, Hx);
  double left = 0, size = 0;
  for (size_t i = 0; i < b.size(); ++i) left += (b[i] - Hx[i]) * (b[i] - Hx[i]), size += b[i] * b[i];
  return std::sqrt(left / size);
}

// Softens rows differently, so that no matrix is a multiple of another.
void change(Matrix& H, double part) {
  for (int row = 0; row < H.rows(); ++row)
    for (int r = 0; r < 3; ++r)
      H.values.block[H.pattern->diagonal(row)](r, r) *= 1 + part * (1 + std::sin(1.7 * row + r));
}

struct Count {
  int factorizations = 0, iterations = 0;
};

// Unrelated right-hand sides, for which only the factor helps.
Count solve_sequence(SequenceSolver& solver, Matrix H, int length, double change_of_each) {
  Count count;
  std::vector<double> x(3 * static_cast<size_t>(H.rows()));
  for (int i = 0; i < length; ++i) {
    const std::vector<double> b = random_vector(3 * H.rows(), 1 + i);
    const SequenceReport report = solver.solve(H.values, b, x);
    EXPECT_TRUE(report.solve.ok) << i;
    EXPECT_LE(relative_residual(H.values, b, x), 1.01e-9) << i;
    EXPECT_LE(report.solve.relative_residual, 1e-9) << i;
    count.factorizations += report.factorized;
    count.iterations += report.solve.iterations;
    change(H, change_of_each);
  }
  return count;
}

Matrix lattice() { return spring_lattice({.nx = 12, .ny = 12, .nz = 12, .stiffness = 1, .mass = 0.01}); }

TEST(SequenceSolver, KeepsAFactorAsLongAsItPays) {
  SequenceSolver solver("cholesky", 1e-9);
  EXPECT_EQ(solve_sequence(solver, lattice(), 8, 0).factorizations, 1);
  solver.begin();
  const Count slow = solve_sequence(solver, lattice(), 12, 1e-3);
  EXPECT_LE(slow.factorizations, 4);
  solver.begin();
  const Count fast = solve_sequence(solver, lattice(), 12, 0.1);
  EXPECT_GT(fast.factorizations, slow.factorizations);
}

TEST(SequenceSolver, SolvesWithEverySolver) {
  for (const std::string& linear : linear_solver_names()) {
    SequenceSolver solver(linear, 1e-9);
    solve_sequence(solver, lattice(), 4, 0.01);
  }
}

TEST(SequenceSolver, IndefiniteMatrixIsReportedWithAnyFactor) {
  Matrix H = lattice();
  SequenceSolver solver("cholesky", 1e-9);
  const std::vector<double> b = random_vector(3 * H.rows(), 1), c = random_vector(3 * H.rows(), 2);
  std::vector<double> x(b.size());
  ASSERT_TRUE(solver.solve(H.values, b, x).solve.ok);
  for (int row = 0; row < H.rows(); ++row)
    for (int r = 0; r < 3; ++r) H.values.block[H.pattern->diagonal(row)](r, r) -= 1;
  const SequenceReport report = solver.solve(H.values, c, x);
  EXPECT_TRUE(report.solve.indefinite);
  EXPECT_FALSE(report.solve.ok);
}

}  // namespace
}  // namespace aspic
