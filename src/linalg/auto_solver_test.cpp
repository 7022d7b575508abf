#include "linalg/auto_solver.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "linalg/matrices_test.h"
#include "linalg/ordering.h"

namespace aspic {
namespace {

using namespace test;

TEST(LinearSolver, IsMadeByName) {
  for (const std::string& name : linear_solver_names()) EXPECT_EQ(make_linear_solver(name)->name(), name);
}

TEST(LinearSolver, MisspeltNameIsAnErrorWithTheNearestOne) {
  try {
    make_linear_solver("colesky");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'cholesky'"), std::string::npos);
  }
}

TEST(CostPrediction, IsWithinAFactorOfThreeOfTheExactCounts) {
  for (const Lattice& box : {Lattice{9, 9, 9}, Lattice{16, 16, 16}, Lattice{28, 7, 7}, Lattice{60, 8, 8}}) {
    const Matrix H = spring_lattice(box);
    const CostPrediction predicted = predict_cholesky(*H.pattern);
    const CholeskyAnalysis exact = find_supernodes(*H.pattern, fill_reducing_order(*H.pattern)).cost;
    EXPECT_LT(std::abs(std::log(predicted.flops / exact.flops)), std::log(3.0)) << box.nx << " x " << box.ny;
    EXPECT_LT(std::abs(std::log(predicted.bytes / (12.0 * exact.nnz))), std::log(3.0)) << box.nx << " x " << box.ny;
  }
}

TEST(AutoSolver, FactorisesSmallAndSlenderAndIteratesOtherwise) {
  struct Case {
    Lattice box;
    bool direct;
  };
  for (const auto& [box, direct] :
       {Case{{28, 7, 7}, true}, Case{{300, 4, 4}, true}, Case{{56, 14, 14}, false}, Case{{20, 20, 20}, false}}) {
    const Matrix H = spring_lattice(box);
    const std::vector<double> b = random_vector(3 * H.rows(), 1);
    std::vector<double> x(b.size());
    AutoSolver solver;
    solver.analyze(*H.pattern);
    EXPECT_EQ(solver.is_direct(), direct) << box.nx << " x " << box.ny;
    ASSERT_TRUE(solver.factorize(H.values));
    const SolveReport report = solver.solve(b, x, 1e-6);
    EXPECT_TRUE(report.ok);
    EXPECT_EQ(report.iterations == 0, direct);
    EXPECT_LE(relative_residual(H.values, b, x), 1e-6 * (1 + 1e-3));
    EXPECT_NE(solver.description().find(direct ? "auto: cholesky" : "auto: block_jacobi"), std::string::npos);
  }
}

// 4 913 vertices in a compact box, too many for a factorisation at once; so stiff that CG does not get there.
Matrix hard_lattice() { return spring_lattice({.nx = 16, .ny = 16, .nz = 16, .stiffness = 1, .mass = 1e-9}); }

TEST(AutoSolver, FallsBackToCholeskyWhereIterationsDoNotConverge) {
  const Matrix H = hard_lattice();
  const std::vector<double> b = random_vector(3 * H.rows(), 2);
  std::vector<double> x(b.size());
  AutoSolver solver;
  solver.analyze(*H.pattern);
  ASSERT_FALSE(solver.is_direct());
  ASSERT_TRUE(solver.factorize(H.values));
  const SolveReport report = solver.solve(b, x, 1e-13);
  EXPECT_TRUE(report.ok);
  EXPECT_EQ(solver.fallbacks(), 1);
  EXPECT_GT(report.iterations, 0);
  solver.solve(b, x, 1e-13);  // the same matrix: the factor is kept
  EXPECT_EQ(solver.fallbacks(), 1);
}

TEST(AutoSolver, IteratesWhereAFactorDoesNotFit) {
  const Matrix H = spring_lattice({.nx = 10, .ny = 5, .nz = 5});
  const std::vector<double> b = random_vector(3 * H.rows(), 3);
  std::vector<double> x(b.size());
  AutoSolver solver(50'000);
  solver.analyze(*H.pattern);
  EXPECT_FALSE(solver.is_direct());
  ASSERT_TRUE(solver.factorize(H.values));
  EXPECT_TRUE(solver.solve(b, x, 1e-8).ok);
  EXPECT_NE(solver.description().find("more than is free"), std::string::npos);
}

TEST(AutoSolver, ReportsIndefiniteMatricesEitherWay) {
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

TEST(AutoSolver, TakesAnotherPattern) {
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
