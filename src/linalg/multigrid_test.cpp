#include "linalg/multigrid.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "base/parallel.h"
#include "linalg/conjugate_gradient.h"
#include "linalg/matrices_test.h"

namespace aspic {
namespace {

using namespace test;

constexpr MultigridOptions kManyLevels = {.aggregate_size = 12, .coarse_aggregate_size = 6, .coarsest_rows = 16};

std::vector<double> applied(Multigrid& multigrid, const std::vector<double>& r) {
  std::vector<double> z(r.size(), std::numeric_limits<double>::quiet_NaN());
  multigrid.apply(r, z);
  return z;
}

Multigrid made(const BlockSparse& H, const MultigridOptions& options = {}) {
  Multigrid multigrid(options);
  multigrid.analyze(*H.pattern);
  EXPECT_TRUE(multigrid.factorize(H));
  return multigrid;
}

// Returns the iterations of conjugate gradients with multigrid, or nothing if they fail.
std::optional<int> iterations(const BlockSparse& H, double tolerance, const MultigridOptions& options = {}) {
  ConjugateGradient solver(std::make_unique<Multigrid>(options), 300);
  solver.analyze(*H.pattern);
  if (!solver.factorize(H)) return {};
  const std::vector<double> b = random_vector(3 * H.pattern->rows(), 1);
  std::vector<double> x(b.size());
  const SolveReport report = solver.solve(b, x, tolerance);
  if (!report.ok || !(relative_residual(H, b, x) <= tolerance * (1 + 1e-3))) return {};
  return report.iterations;
}

TEST(Multigrid, CoarsestLevelAloneIsExact) {
  const Matrix H = spring_lattice({.nx = 4, .ny = 4, .nz = 4});
  Multigrid multigrid = made(H.values);
  EXPECT_EQ(multigrid.level_count(), 1);
  const std::vector<double> b = random_vector(3 * H.rows(), 2), x = applied(multigrid, b);
  // Input and output are in single precision; the condition number is below 30.
  EXPECT_LT(relative_residual(H.values, b, x), 30 * std::numeric_limits<float>::epsilon());
}

TEST(Multigrid, IsSymmetricAndPositiveWithTwoLevels) {
  for (const double stiffness : {1.0, 1e3}) {
    const Matrix H = spring_lattice({.nx = 12, .ny = 6, .nz = 6, .stiffness = stiffness});
    Multigrid multigrid = made(H.values);
    ASSERT_EQ(multigrid.level_count(), 2);
    for (const unsigned seed : {1U, 2U, 3U}) {
      const std::vector<double> u = random_vector(3 * H.rows(), seed), v = random_vector(3 * H.rows(), seed + 10);
      const std::vector<double> Mu = applied(multigrid, u), Mv = applied(multigrid, v);
      EXPECT_GT(dot(u, Mu), 0);
      // Single-precision errors accumulate in sums of about 200 entries.
      const double scale = std::sqrt(dot(u, u) * dot(Mv, Mv)) + std::sqrt(dot(v, v) * dot(Mu, Mu));
      EXPECT_LT(std::abs(dot(u, Mv) - dot(v, Mu)), 10 * std::numeric_limits<float>::epsilon() * scale);
    }
  }
}

TEST(Multigrid, IsPositiveAndHomogeneousWithManyLevels) {
  const Matrix H = spring_lattice({.nx = 20, .ny = 10, .nz = 10, .stiffness = 1e3});
  Multigrid multigrid = made(H.values, kManyLevels);
  ASSERT_GE(multigrid.level_count(), 4);
  for (const unsigned seed : {1U, 2U, 3U}) {
    std::vector<double> u = random_vector(3 * H.rows(), seed);
    const std::vector<double> Mu = applied(multigrid, u);
    EXPECT_GT(dot(u, Mu), 0);
    for (double& value : u) value *= -1024;  // a power of two: the same roundings
    const std::vector<double> scaled = applied(multigrid, u);
    for (size_t i = 0; i < u.size(); ++i) ASSERT_EQ(scaled[i], -1024 * Mu[i]);
  }
  EXPECT_EQ(applied(multigrid, std::vector<double>(3 * H.rows())), std::vector<double>(3 * H.rows()));
}

TEST(Multigrid, IsBitReproducibleForAnyThreadCount) {
  const Matrix H = spring_lattice({.nx = 24, .ny = 12, .nz = 12, .stiffness = 1e3});
  const std::vector<double> b = random_vector(3 * H.rows(), 3);
  const int threads = thread_count();
  std::vector<double> expected;
  for (const int count : {1, 2, 3, 8}) {
    set_thread_count(count);
    Multigrid multigrid = made(H.values, kManyLevels);
    const std::vector<double> z = applied(multigrid, b);
    if (expected.empty()) expected = z;
    EXPECT_EQ(z, expected) << count << " threads";
  }
  set_thread_count(threads);
}

// A lattice pinned at one end.
Matrix clamped_lattice(const Lattice& box) {
  Matrix H = spring_lattice(box);
  for (int row = 0; row < H.rows(); ++row)
    if (H.pattern->rest_position[row][0] == 0) pin(H.values, row);
  return H;
}

TEST(Multigrid, IterationsHardlyGrowOnFinerMeshes) {
  for (const bool is_static : {false, true}) {
    std::vector<int> count;
    for (const int cells : {6, 12, 24}) {  // 343, 2 197 and 15 625 vertices
      const double mass = is_static ? 1e-6 : 24.0 * 24 / (cells * cells) * 1e-2;
      const Matrix H = clamped_lattice({cells, cells, cells, 1, mass});
      const auto taken = iterations(H.values, 1e-8, {.coarsest_rows = 20});
      ASSERT_TRUE(taken);
      count.push_back(*taken);
    }
    EXPECT_LE(count[1], 1.3 * count[0]);
    EXPECT_LE(count[2], 1.3 * count[1]);
    EXPECT_LE(count[2], 30);
  }
}

TEST(Multigrid, NeedsFewIterationsForStiffAndFreeBodies) {
  const Lattice box = {.nx = 24, .ny = 8, .nz = 8};
  for (const double stiffness : {1.0, 1e4, 1e8})
    for (const double mass : {1.0, 1e-6}) {
      const Matrix H = spring_lattice({box.nx, box.ny, box.nz, stiffness, mass});
      // Forces of a random displacement: others would move a body with almost no mass so far that its deformation is
      // below round-off.
      const std::vector<double> u = random_vector(3 * H.rows(), 11);
      std::vector<double> b(u.size()), x(u.size());
      H.values.multiply(u, b);
      ConjugateGradient solver(std::make_unique<Multigrid>());
      solver.analyze(*H.pattern);
      ASSERT_TRUE(solver.factorize(H.values));
      const SolveReport report = solver.solve(b, x, 1e-4);
      EXPECT_TRUE(report.ok) << stiffness << ", " << mass;
      EXPECT_LE(relative_residual(H.values, b, x), 1e-4 * (1 + 1e-3));
      EXPECT_LE(report.iterations, 20) << stiffness << ", " << mass;
    }
}

TEST(Multigrid, ReportsMissedToleranceWhenIllConditioned) {
  const Matrix H =
      spring_lattice({24, 8, 8, 1e8, 1e-6});  // random forces push it far away: the condition number is 1e15
  ConjugateGradient solver(std::make_unique<Multigrid>(), 300);
  solver.analyze(*H.pattern);
  if (!solver.factorize(H.values)) return;
  const std::vector<double> b = random_vector(3 * H.rows(), 1);
  std::vector<double> x(b.size());
  const SolveReport report = solver.solve(b, x, 1e-8);
  EXPECT_FALSE(report.ok);
  EXPECT_GT(relative_residual(H.values, b, x), 1e-8);
}

// Bending of a thin body is not affine on an aggregate: these are the hardest cases.
TEST(Multigrid, ConvergesForRodAndSheet) {
  struct Case {
    Lattice box;
    int most;
  };
  for (const auto& [box, most] : {Case{{400, 1, 1, 1e4, 1}, 120}, Case{{40, 40, 1, 1e4, 1}, 55}}) {
    const auto taken = iterations(clamped_lattice(box).values, 1e-6);
    ASSERT_TRUE(taken);
    EXPECT_LE(*taken, most) << box.nx << " x " << box.ny;
  }
}

// Half of the aggregates have no functions.
TEST(Multigrid, ConvergesWithRowsOfAngles) {
  const Matrix H = spring_lattice({.nx = 24, .ny = 8, .nz = 8, .stiffness = 10});
  H.pattern->angle_rows = H.rows() / 2;
  EXPECT_GE(made(H.values).level_count(), 2);
  const auto taken = iterations(H.values, 1e-6);
  ASSERT_TRUE(taken);
  EXPECT_LE(*taken, 60);
}

TEST(Multigrid, HasNoCoarseLevelWithoutFunctions) {
  const Matrix H = spring_lattice({.nx = 24, .ny = 8, .nz = 8, .stiffness = 10});
  H.pattern->angle_rows = H.rows();
  EXPECT_EQ(made(H.values).level_count(), 1);
  EXPECT_TRUE(iterations(H.values, 1e-6));
}

TEST(Multigrid, SolvesPinnedRowsExactly) {
  Matrix H = spring_lattice({.nx = 16, .ny = 6, .nz = 6, .stiffness = 100});
  for (int row = 0; row < H.rows(); row += 9) pin(H.values, row);
  Multigrid multigrid = made(H.values);
  ASSERT_GE(multigrid.level_count(), 2);
  std::vector<double> b = random_vector(3 * H.rows(), 4);
  const std::vector<double> z = applied(multigrid, b);
  for (int row = 0; row < H.rows(); row += 9)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(z[3 * row + k], static_cast<float>(b[3 * row + k])) << row;
}

TEST(Multigrid, IsIndependentOfPinnedRowScale) {
  std::vector<int> count;
  for (const double scale : {1.0, 1e-8, 1e8}) {
    Matrix H = spring_lattice({16, 8, 8, 100 * scale, scale});
    for (int row = 0; row < H.rows(); row += 7) pin(H.values, row);
    std::vector<double> b = random_vector(3 * H.rows(), 14), x(b.size());
    for (int row = 0; row < H.rows(); row += 7) std::fill_n(&b[3 * row], 3, 0.0);
    ConjugateGradient solver(std::make_unique<Multigrid>(kManyLevels));
    solver.analyze(*H.pattern);
    ASSERT_TRUE(solver.factorize(H.values));
    const SolveReport report = solver.solve(b, x, 1e-8);
    EXPECT_TRUE(report.ok);
    count.push_back(report.iterations);
  }
  EXPECT_EQ(count, std::vector<int>(3, count[0]));
}

TEST(Multigrid, FollowsChangingPinnedRows) {
  const Matrix free = spring_lattice({.nx = 16, .ny = 6, .nz = 6, .stiffness = 100});
  const std::vector<double> b = random_vector(3 * free.rows(), 5);
  Multigrid reused;
  reused.analyze(*free.pattern);
  for (const int step : {9, 5, 1000, 9}) {
    BlockSparse H = free.values;
    for (int row = 0; row < free.rows(); row += step) pin(H, row);
    ASSERT_TRUE(reused.factorize(H));
    Multigrid fresh = made(H);
    EXPECT_EQ(applied(reused, b), applied(fresh, b)) << step;
    EXPECT_TRUE(iterations(H, 1e-8));
  }
}

TEST(Multigrid, AcceptsSmallAndEmptyMatrices) {
  const Matrix nothing = random_dominant(0, {}, 6);
  Multigrid multigrid = made(nothing.values);
  EXPECT_TRUE(applied(multigrid, {}).empty());
  for (const int rows : {1, 2, 5}) {
    const Matrix H = random_dominant(rows, random_couplings(rows, rows, 6), 7);
    EXPECT_TRUE(iterations(H.values, 1e-10)) << rows;
  }
}

TEST(Multigrid, WorksWithoutRestPositions) {
  Matrix H = spring_lattice({.nx = 16, .ny = 8, .nz = 8, .stiffness = 10});
  const auto with = iterations(H.values, 1e-6);
  H.pattern->rest_position.clear();
  const auto without = iterations(H.values, 1e-6);
  ASSERT_TRUE(with && without);
  EXPECT_LT(*with, *without);
  EXPECT_LE(*without, 60);
}

// A coarsest level as large as the matrix would need 6.5 GB.
TEST(Multigrid, AcceptsManyDisconnectedRows) {
  const int rows = 10'000;
  EXPECT_EQ(iterations(random_dominant(rows, {}, 8).values, 1e-6), 1);  // all rows are isolated
  Couplings pairs, paths;
  for (int row = 0; row + 1 < rows; ++row) {
    if (row % 2 == 0) pairs.emplace_back(row, row + 1);
    if (row % 40 != 39) paths.emplace_back(row, row + 1);  // can be coarsened, but only a few times
  }
  for (const Couplings& couplings : {pairs, paths}) {
    const auto taken = iterations(random_dominant(rows, couplings, 9).values, 1e-6);
    ASSERT_TRUE(taken);
    EXPECT_LE(*taken, 20);
  }
  EXPECT_EQ(made(random_dominant(rows, paths, 9).values).level_count(), 2);
}

TEST(Multigrid, AcceptsModulusJumpsEverywhere) {
  Matrix H = spring_lattice({.nx = 20, .ny = 20, .nz = 20, .stiffness = 10});
  for (int row = 0; row < H.rows(); ++row) H.pattern->rest_modulus.push_back(std::pow(100.0, row * 7 % 10));
  EXPECT_GE(made(H.values).level_count(), 3);
  const auto taken = iterations(H.values, 1e-6);
  ASSERT_TRUE(taken);
  EXPECT_LE(*taken, 20);
}

// Coarse spaces contain the rigid motions, diagonal blocks the rest.
TEST(Multigrid, RejectsNegativeMass) {
  for (const double mass : {-0.1, -3.0, -1e3})
    for (const int cells : {3, 8, 16}) {
      const Matrix H = spring_lattice({cells, 6, 6, 10, mass});
      Multigrid multigrid(kManyLevels);
      multigrid.analyze(*H.pattern);
      EXPECT_FALSE(multigrid.factorize(H.values)) << mass << ", " << cells;
    }
}

// Couples two rows so strongly that their difference has a negative energy, which neither diagonal blocks nor coarse
// matrices reveal.
void couple_too_strongly(BlockSparse& H, int row) {
  const int64_t s = H.pattern->row_start[row];
  ASSERT_LT(s, H.pattern->diagonal(row));
  const double largest =
      std::max(trace(H.block[H.pattern->diagonal(row)]), trace(H.block[H.pattern->diagonal(H.pattern->column[s])]));
  H.block[s] = H.block[s] + 1.5 * largest * identity3<double>();
}

TEST(Multigrid, DetectsNegativeCurvatureHiddenFromLevels) {
  int met = 0;
  for (const int cells : {8, 16})
    for (const int place : {2, 3, 5}) {
      Matrix H = spring_lattice({cells, 6, 6, 10, 1});
      couple_too_strongly(H.values, H.rows() / place);
      ConjugateGradient solver(std::make_unique<Multigrid>(kManyLevels));
      solver.analyze(*H.pattern);
      if (!solver.factorize(H.values)) continue;
      const std::vector<double> b = random_vector(3 * H.rows(), 12);
      std::vector<double> x(b.size());
      const SolveReport report = solver.solve(b, x, 1e-8);
      EXPECT_TRUE(report.indefinite) << cells << ", " << place;
      EXPECT_FALSE(report.ok);
      EXPECT_GT(dot(b, x), 0);
      ++met;
    }
  EXPECT_GE(met, 3);
}

TEST(Multigrid, ReportsIndefiniteMatrixWhenReused) {
  const Matrix H = spring_lattice({16, 6, 6, 10, 1});
  BlockSparse next(*H.pattern);
  next.block = spring_lattice({16, 6, 6, 10, -0.1}).values.block;
  ConjugateGradient solver(std::make_unique<Multigrid>(kManyLevels));
  solver.analyze(*H.pattern);
  const std::vector<double> b = random_vector(3 * H.rows(), 13);
  std::vector<double> x(b.size());
  ASSERT_TRUE(solver.factorize(H.values));
  EXPECT_TRUE(solver.solve(b, x, 1e-8).ok);
  ASSERT_TRUE(solver.factorize(next));  // reuses the preconditioner without inspecting the matrix
  const SolveReport report = solver.solve(b, x, 1e-8);
  EXPECT_TRUE(report.indefinite);
  EXPECT_FALSE(report.ok);
  EXPECT_GT(dot(b, x), 0);
  solver.begin();
  EXPECT_FALSE(solver.factorize(next));
}

TEST(Multigrid, RejectsNaN) {
  Matrix H = spring_lattice({.nx = 16, .ny = 6, .nz = 6});
  H.values.block[H.pattern->diagonal(100)](0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(iterations(H.values, 1e-6));
  H.values.block[H.pattern->diagonal(100)] = 100.0 * identity3<double>();
  EXPECT_TRUE(iterations(H.values, 1e-6));
}

TEST(Multigrid, DescribesLevels) {
  const Matrix H = spring_lattice({.nx = 12, .ny = 6, .nz = 6});
  EXPECT_EQ(Multigrid().description(), "multigrid");
  EXPECT_EQ(made(H.values).description().find("multigrid on levels of 637, "), 0U);
}

}  // namespace
}  // namespace aspic
