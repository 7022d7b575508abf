#include "linalg/lifted_solver.h"

#include <gtest/gtest.h>

#include <random>

#include "linalg/auto_solver.h"
#include "linalg/multigrid.h"
#include "math/vectors.h"

namespace aspic {
namespace {

// A chain of blocks with stiff rows that act on ten consecutive vertices each.
class StiffChain {
 public:
  explicit StiffChain(double weight, int rows = 400) : pattern_(make_pattern(rows, couplings(rows))), H(pattern_) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < rows; ++i) pattern_.rest_position.push_back({{0.1 * i, uniform(random), uniform(random)}});
    for (int i = 0; i < rows; ++i) {
      H.block[pattern_.diagonal(i)] = (i == 0 ? 4.0 : 2.01) * identity3<double>();
      if (i > 0) H.block[pattern_.slot(i, i - 1)] = -1.0 * identity3<double>();
    }
    for (int first = 0; first + 10 <= rows; first += 7) {
      StiffRow& row = stiff.emplace_back();
      for (int n = 0; n < 10; ++n) {
        row.vertex[n] = first + (3 * n) % 10;  // in any order
        for (int r = 0; r < 3; ++r) row.g[n][r] = uniform(random);
      }
      row.weight = weight, row.compliance = 10;
      add(row);
    }
    for (int i = 0; i < 3 * rows; ++i) b.push_back(uniform(random));
  }

  std::vector<double> residual(const std::vector<double>& x) const {
    std::vector<double> r(x.size());
    H.multiply(x, r);
    for (size_t i = 0; i < r.size(); ++i) r[i] = b[i] - r[i];
    return r;
  }

 private:
  static Couplings couplings(int rows) {
    Couplings list;
    for (int i = 0; i < rows; ++i)
      for (int j = std::max(0, i - 9); j < i; ++j) list.emplace_back(i, j);
    return list;
  }
  void add(const StiffRow& row) {
    for (int n = 0; n < 10; ++n)
      for (int m = 0; m < 10; ++m) {
        if (row.vertex[m] > row.vertex[n]) continue;
        Mat3d& block = H.block[pattern_.slot(row.vertex[n], row.vertex[m])];
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) block(r, c) += row.weight * row.g[n][r] * row.g[m][c];
      }
  }

  BlockPattern pattern_;

 public:
  BlockSparse H;
  StiffRows stiff;
  std::vector<double> b;
  const BlockPattern& pattern() const { return pattern_; }
};

SolveReport solved(const StiffChain& chain, LinearSolver& solver, bool is_lifted, std::vector<double>& x) {
  x.resize(chain.b.size());
  solver.analyze(chain.pattern());
  solver.set_stiff_rows(is_lifted ? &chain.stiff : nullptr);
  EXPECT_TRUE(solver.factorize(chain.H));
  return solver.solve(chain.b, x, 1e-6);
}

TEST(LiftedSolver, IterationsDoNotDependOnStiffness) {
  std::vector<double> x;
  int fewest = 1000, most = 0;
  for (const double weight : {1.0, 1e3, 1e6}) {
    const StiffChain chain(weight);
    const auto solver = make_linear_solver("multigrid");
    const SolveReport report = solved(chain, *solver, true, x);
    EXPECT_TRUE(report.ok) << weight << ' ' << report.relative_residual;
    EXPECT_LE(norm(chain.residual(x)), 1.01e-6 * norm(chain.b));
    fewest = std::min(fewest, report.iterations), most = std::max(most, report.iterations);
  }
  EXPECT_LT(most, 3 * fewest);
  const StiffChain chain(1e6);
  const auto plain = make_linear_solver("multigrid");
  EXPECT_GT(solved(chain, *plain, false, x).iterations, 2 * most);
}

TEST(LiftedSolver, AgreesWithCholesky) {
  const StiffChain chain(1e4);
  std::vector<double> lifted, direct;
  const auto multigrid = make_linear_solver("multigrid"), cholesky = make_linear_solver("cholesky");
  solved(chain, *multigrid, true, lifted);
  EXPECT_TRUE(solved(chain, *cholesky, true, direct).ok);
  add_scaled(-1, direct, lifted);
  EXPECT_LT(norm(lifted), 1e-4 * norm(direct));
}

TEST(LiftedSolver, ReportsNegativeCurvature) {
  StiffChain chain(1e-3);
  for (int i = 0; i < chain.pattern().rows(); ++i)
    chain.H.block[chain.pattern().diagonal(i)] = -1.0 * chain.H.block[chain.pattern().diagonal(i)];
  LiftedSolver solver;
  solver.separate(chain.H, chain.stiff);
  std::vector<double> x(chain.b.size());
  const auto copy = [](std::span<const double> r, std::span<double> z) { std::copy(r.begin(), r.end(), z.begin()); };
  const SolveReport report = solver.solve(chain.b, x, 1e-3, copy);
  EXPECT_TRUE(report.indefinite);
  EXPECT_FALSE(report.ok);
}

TEST(LiftedSolver, AutoSolverAvoidsBlockJacobi) {
  const StiffChain chain(1e5);
  AutoSolver solver;
  solver.analyze(chain.pattern());
  solver.set_stiff_rows(&chain.stiff);
  EXPECT_TRUE(solver.factorize(chain.H));
  EXPECT_NE(solver.chosen().name(), "block_jacobi");
}

}  // namespace
}  // namespace aspic
