#include "linalg/auto_solver.h"

#include <gtest/gtest.h>

#include <utility>

#include "base/error.h"
#include "linalg/matrices_test.h"
#include "linalg/multigrid.h"
#include "linalg/ordering.h"

namespace aspic {
namespace {

using namespace test;

TEST(LinearSolver, IsMadeByName) {
  for (const std::string& name : linear_solver_names()) EXPECT_EQ(make_linear_solver(name)->name(), name);
}

TEST(LinearSolver, RejectsMisspeltNameWithSuggestion) {
  try {
    make_linear_solver("colesky");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'cholesky'"), std::string::npos);
  }
}

TEST(CostPrediction, IsWithinFactorThreeOfExactCounts) {
  for (const Lattice& box : {Lattice{9, 9, 9}, Lattice{16, 16, 16}, Lattice{28, 7, 7}, Lattice{60, 8, 8}}) {
    const Matrix H = spring_lattice(box);
    const CostPrediction predicted = predict_cholesky(*H.pattern);
    const CholeskyAnalysis exact = find_supernodes(*H.pattern, fill_reducing_order(*H.pattern)).cost;
    EXPECT_LT(std::abs(std::log(predicted.flops / exact.flops)), std::log(3.0)) << box.nx << " x " << box.ny;
    EXPECT_LT(std::abs(std::log(predicted.entries / static_cast<double>(exact.nnz))), std::log(3.0))
        << box.nx << " x " << box.ny;
  }
}

TEST(AutoSolver, ChoosesByMatrix) {
  struct Case {
    Lattice box;
    std::string chosen;
  };
  for (const auto& [box, chosen] : {Case{{3, 3, 3, 1, 1}, "cholesky"}, Case{{28, 7, 7, 1, 1}, "block_jacobi"},
                                    Case{{28, 7, 7, 1e4, 1}, "multigrid"}, Case{{400, 1, 1, 1e4, 1}, "cholesky"},
                                    Case{{20, 20, 20, 1, 1}, "block_jacobi"}}) {
    const Matrix H = spring_lattice(box);
    const std::vector<double> b = random_vector(3 * H.rows(), 1);
    std::vector<double> x(b.size());
    AutoSolver solver;
    solver.analyze(*H.pattern);
    ASSERT_TRUE(solver.factorize(H.values));
    EXPECT_EQ(solver.chosen().name(), chosen) << box.nx << " x " << box.ny << ", " << solver.description();
    const SolveReport report = solver.solve(b, x, 1e-6);
    EXPECT_TRUE(report.ok);
    EXPECT_EQ(report.iterations == 0, chosen == "cholesky");
    EXPECT_EQ(report.cycles > 0, chosen == "multigrid");
    EXPECT_LE(relative_residual(H.values, b, x), 1e-6 * (1 + 1e-3));
    EXPECT_NE(solver.description().find("auto: " + chosen), std::string::npos);
  }
}

TEST(AutoSolver, FactorizesForManyRightHandSides) {
  const Matrix H = spring_lattice({28, 7, 7, 1, 1});
  for (const int solves : {1, 50}) {
    AutoSolver solver(std::numeric_limits<int64_t>::max(), solves);
    solver.analyze(*H.pattern);
    ASSERT_TRUE(solver.factorize(H.values));
    EXPECT_EQ(solver.chosen().name() == "cholesky", solves == 50) << solver.description();
  }
}

TEST(AutoSolver, PredictsIterationsWithinFactorTwo) {
  for (const double stiffness :
       {1.0, 10.0, 100.0}) {  // stiffer ones need fewer than predicted, because the size limits them
    const Matrix H = spring_lattice({.nx = 12, .ny = 6, .nz = 6, .stiffness = stiffness});
    const std::vector<double> b = random_vector(3 * H.rows(), 5);
    std::vector<double> x(b.size());
    ConjugateGradient cg;
    cg.analyze(*H.pattern);
    ASSERT_TRUE(cg.factorize(H.values));
    const double taken = cg.solve(b, x, 1e-2).iterations, predicted = predict_iterations(H.values);
    EXPECT_LT(predicted / taken, 2) << stiffness << ": " << taken;
    EXPECT_GT(predicted / taken, 0.5) << stiffness << ": " << taken;
  }
}

// Puts rollers on three faces of a box, which fix their vertices along the normal.
void hold_faces(const Lattice& box, Matrix& H) {
  const auto holds = [&](int row, int axis) { return H.pattern->rest_position[row][axis] == 0; };
  for (int row = 0; row < H.rows(); ++row)
    for (int64_t s = H.pattern->row_start[row]; s < H.pattern->row_start[row + 1]; ++s)
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          if (holds(row, r) || holds(H.pattern->column[s], c))
            H.values.block[s](r, c) = H.pattern->column[s] == row && r == c ? box.stiffness : 0;
}

TEST(PredictIterations, IgnoresRowsBesideRollers) {
  for (const double stiffness : {1.0, 10.0, 100.0}) {
    const Lattice box{.nx = 12, .ny = 6, .nz = 6, .stiffness = stiffness};
    Matrix H = spring_lattice(box);
    const double unheld = predict_iterations(H.values);
    hold_faces(box, H);
    EXPECT_NEAR(predict_iterations(H.values) / unheld, 1, 0.1) << stiffness;
  }
}

TEST(PredictIterations, IgnoresRoundOffOfBodyAtRest) {
  for (const double sign : {-1, 1}) {
    Matrix H = spring_lattice({.nx = 6, .ny = 6, .nz = 6, .stiffness = 1, .mass = 0});
    for (int row = 0; row < H.rows(); ++row)
      for (int r = 0; r < 3; ++r) H.values.block[H.pattern->diagonal(row)](r, r) *= 1 + sign * 1e-15;
    EXPECT_TRUE(std::isinf(predict_iterations(H.values))) << sign;
  }
}

// 4 913 vertices in a compact box, pinned at one of them. This makes a uniform displacement stiff, on which the
// prediction is based, but the rotations about the pin remain almost free, so conjugate gradients converge slowly.
Matrix hard_lattice() {
  Matrix H = spring_lattice({.nx = 16, .ny = 16, .nz = 16, .stiffness = 1, .mass = 1e-9});
  for (int r = 0; r < 3; ++r) H.values.block[H.pattern->diagonal(0)](r, r) += 1e6;
  return H;
}

TEST(AutoSolver, FallsBackWhenIterationsDoNotConverge) {
  const Matrix H = hard_lattice();
  const std::vector<double> b = random_vector(3 * H.rows(), 2);
  std::vector<double> x(b.size());
  AutoSolver solver;
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  ASSERT_EQ(solver.chosen().name(), "block_jacobi");
  const SolveReport report = solver.solve(b, x, 1e-8);
  EXPECT_TRUE(report.ok);
  EXPECT_GE(solver.fallbacks(), 1);
  EXPECT_NE(solver.chosen().name(), "block_jacobi");
  EXPECT_GT(report.iterations, 0);
  const int64_t fallbacks = solver.fallbacks();
  solver.solve(b, x, 1e-8);  // the same matrix: keeps the choice
  EXPECT_EQ(solver.fallbacks(), fallbacks);
}

template <class Solver>
SolveReport solved(Solver&& solver, const BlockSparse& H, const std::vector<double>& b, double tolerance) {
  std::vector<double> x(b.size());
  solver.analyze(*H.pattern);
  EXPECT_TRUE(solver.factorize(H));
  return solver.solve(b, x, tolerance);
}

constexpr int kCyclesPerFactorization = 193;  // cycles on hard_lattice() that cost as much as a factorization

TEST(AutoSolver, CountsFailedAttempts) {
  const Matrix H = hard_lattice();
  const std::vector<double> b = random_vector(3 * H.rows(), 2);
  for (const double tolerance : {1e-5, 1e-13}) {
    const SolveReport first = solved(ConjugateGradient(300), H.values, b, tolerance);
    const SolveReport second =
        solved(ConjugateGradient(std::make_unique<Multigrid>(), kCyclesPerFactorization), H.values, b, tolerance);
    const SolveReport third = second.ok ? SolveReport() : solved(Cholesky(), H.values, b, tolerance);
    AutoSolver solver;
    const SolveReport total = solved(solver, H.values, b, tolerance);
    EXPECT_FALSE(first.ok);
    EXPECT_EQ(first.iterations, 300);
    EXPECT_EQ(total.iterations, first.iterations + second.iterations);
    EXPECT_EQ(total.products, first.products + second.products + third.products);
    EXPECT_EQ(total.cycles, second.cycles);
    EXPECT_EQ(solver.fallbacks(), second.ok ? 1 : 2);
    EXPECT_GT(total.cycles, 0);
  }
}

TEST(AutoSolver, ReturnsToMultigridAfterOneSlowMatrix) {
  const Matrix hard = hard_lattice();
  BlockSparse easy(*hard.pattern);
  easy.block = spring_lattice({.nx = 16, .ny = 16, .nz = 16, .stiffness = 1e4}).values.block;
  const std::vector<double> b = random_vector(3 * hard.rows(), 6);
  std::vector<double> x(b.size());
  AutoSolver solver;
  solver.analyze(*hard.pattern);
  for (const BlockSparse* H : {&std::as_const(easy), &hard.values, &std::as_const(easy)}) {
    ASSERT_TRUE(solver.factorize(*H));
    EXPECT_EQ(solver.chosen().name(), "multigrid");
    EXPECT_TRUE(solver.solve(b, x, 1e-13).ok);
    EXPECT_EQ(solver.chosen().name() == "cholesky", H == &hard.values);
  }
}

TEST(AutoSolver, NewSequenceIsIndependentOfEarlierOnes) {
  const Matrix hard = hard_lattice();
  for (const double stiffness : {1.0, 1e4}) {  // for block_jacobi and multigrid
    const Matrix other = spring_lattice({.nx = 16, .ny = 16, .nz = 16, .stiffness = stiffness});
    BlockSparse H(*hard.pattern), softer(*hard.pattern);
    H.block = other.values.block;
    softer.block = spring_lattice({.nx = 16, .ny = 16, .nz = 16, .stiffness = 0.8 * stiffness}).values.block;
    const std::vector<double> b = random_vector(3 * hard.rows(), 6);
    std::vector<double> x(b.size()), expected(b.size());
    AutoSolver old, fresh;
    old.analyze(*hard.pattern);
    fresh.analyze(*hard.pattern);
    for (const BlockSparse* before : {&hard.values, &std::as_const(softer), &std::as_const(softer)}) {
      old.begin();
      ASSERT_TRUE(old.factorize(*before));
      EXPECT_TRUE(old.solve(b, x, 1e-6).ok);
    }
    EXPECT_GE(old.fallbacks(), 1);
    old.begin();
    fresh.begin();
    for (const BlockSparse* now : {&std::as_const(H), &std::as_const(softer)}) {
      ASSERT_TRUE(old.factorize(*now));
      ASSERT_TRUE(fresh.factorize(*now));
      EXPECT_EQ(old.chosen().name(), fresh.chosen().name());
      const SolveReport report = old.solve(b, x, 1e-6), expected_report = fresh.solve(b, expected, 1e-6);
      EXPECT_EQ(x, expected);
      EXPECT_EQ(report.iterations, expected_report.iterations);
    }
    EXPECT_EQ(fresh.chosen().name(), stiffness == 1 ? "block_jacobi" : "multigrid");
  }
}

TEST(AutoSolver, KeepsChoiceAndDescendsAtDeadline) {
  double now = 0;
  const WallClock clock = [&] { return now++; };
  const Matrix hard = hard_lattice(), stiff = spring_lattice({28, 7, 7, 1e4, 1});
  for (const Matrix* H : {&hard, &stiff}) {
    const std::vector<double> b = random_vector(3 * H->rows(), 7);
    std::vector<double> x(b.size());
    AutoSolver solver;
    solver.set_stop(StopToken(clock, 2.5));
    solver.analyze(*H->pattern);
    ASSERT_TRUE(solver.factorize(H->values));
    const SolveReport report = solver.solve(b, x, 1e-10);
    EXPECT_TRUE(report.stopped);
    EXPECT_FALSE(report.ok);
    EXPECT_EQ(report.iterations, 3);
    EXPECT_EQ(report.cycles, H == &stiff ? 4 : 0);
    EXPECT_EQ(solver.fallbacks(), 0);
    EXPECT_GT(dot(b, x), 0);
  }
}

TEST(AutoSolver, IteratesWhenFactorDoesNotFit) {
  const Matrix H = spring_lattice({.nx = 10, .ny = 5, .nz = 5});
  const std::vector<double> b = random_vector(3 * H.rows(), 3);
  std::vector<double> x(b.size());
  AutoSolver solver(50'000);
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  EXPECT_NE(solver.chosen().name(), "cholesky");
  EXPECT_TRUE(solver.solve(b, x, 1e-8).ok);
  EXPECT_NE(solver.description().find("more than the free memory"), std::string::npos);
}

TEST(AutoSolver, ReportsIndefiniteMatrices) {
  for (const Lattice& box : {Lattice{6, 6, 6, 10, -0.5}, Lattice{20, 20, 20, 10, -0.5}}) {
    const Matrix H = spring_lattice(box);
    const std::vector<double> b(3 * H.rows(), 1.0);
    std::vector<double> x(b.size());
    AutoSolver solver;
    solver.analyze(*H.pattern);
    const bool definite = solver.factorize(H.values) && !solver.solve(b, x, 1e-6).indefinite;
    EXPECT_FALSE(definite);
  }
}

TEST(AutoSolver, AcceptsAnotherPattern) {
  AutoSolver solver;
  for (const int cells : {20, 3, 16, 0}) {
    const Matrix H = spring_lattice({.nx = cells, .ny = cells, .nz = cells});
    const std::vector<double> b = random_vector(3 * H.rows(), 4);
    std::vector<double> x(b.size());
    solver.analyze(*H.pattern);
    ASSERT_TRUE(solver.factorize(H.values));
    EXPECT_TRUE(solver.solve(b, x, 1e-8).ok);
  }
}

}  // namespace
}  // namespace aspic
