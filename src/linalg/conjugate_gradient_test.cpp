#include "linalg/conjugate_gradient.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/parallel.h"
#include "linalg/matrices_test.h"
#include "linalg/multigrid.h"

namespace aspic {
namespace {

using namespace test;

TEST(BlockInverse, TimesTheBlockIsTheIdentity) {
  const Matrix H = random_dominant(20, {}, 1);
  for (const Mat3d& A : H.values.block) {
    Mat3d inverse;
    ASSERT_TRUE(invert_positive_definite(A, inverse));
    EXPECT_LT(squared_norm(A * inverse - identity3<double>()), 1e-28);  // condition number < 10: a few eps per entry
  }
}

TEST(BlockInverse, RejectsIndefiniteBlocks) {
  Mat3d inverse;
  EXPECT_FALSE(invert_positive_definite(Mat3d{}, inverse));
  EXPECT_FALSE(invert_positive_definite(Mat3d{{1, 2, 0, 2, 1, 0, 0, 0, 1}}, inverse));
  EXPECT_FALSE(invert_positive_definite(Mat3d{{1, 0, 0, 0, 1, 0, 0, 0, -1}}, inverse));
  EXPECT_FALSE(invert_positive_definite(std::numeric_limits<double>::quiet_NaN() * identity3<double>(), inverse));
}

TEST(ConjugateGradient, ReachesToleranceAndReportsResidual) {
  const Matrix H = spring_lattice({.nx = 12, .ny = 5, .nz = 5, .stiffness = 100});
  const std::vector<double> b = random_vector(3 * H.rows(), 2);
  ConjugateGradient solver;
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  int iterations = 0;
  for (const double tolerance : {1e-2, 1e-6, 1e-12}) {
    std::vector<double> x(b.size(), 99.0);  // overwritten: not an initial guess
    const SolveReport report = solver.solve(b, x, tolerance);
    EXPECT_TRUE(report.ok);
    EXPECT_FALSE(report.indefinite);
    EXPECT_LE(relative_residual(H.values, b, x), tolerance * (1 + 1e-3));  // the measured residual has round-off, too
    EXPECT_NEAR(report.relative_residual, relative_residual(H.values, b, x), 1e-12);  // the recurrence drifts
    EXPECT_GT(report.iterations, iterations);
    iterations = report.iterations;
  }
}

TEST(ConjugateGradient, SolvesBlockDiagonalMatrixInOneIteration) {
  const Matrix H = random_dominant(10, {}, 3);
  const std::vector<double> b = random_vector(30, 4);
  std::vector<double> x(30);
  ConjugateGradient solver;
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  const SolveReport report = solver.solve(b, x, 1e-12);
  EXPECT_TRUE(report.ok);
  EXPECT_EQ(report.iterations, 1);
}

TEST(ConjugateGradient, ReportsMissedTolerance) {
  const Matrix H = spring_lattice({.nx = 12, .ny = 5, .nz = 5, .stiffness = 1e4});
  const std::vector<double> b = random_vector(3 * H.rows(), 5);
  std::vector<double> x(b.size());
  ConjugateGradient capped(3);
  capped.analyze(*H.pattern);
  ASSERT_TRUE(capped.factorize(H.values));
  const SolveReport report = capped.solve(b, x, 1e-8);
  EXPECT_FALSE(report.ok);
  EXPECT_EQ(report.iterations, 3);
  EXPECT_NEAR(report.relative_residual, relative_residual(H.values, b, x), 1e-15);

  ConjugateGradient patient;  // cannot reach 1e-18 in double precision, but stops when it stagnates
  patient.analyze(*H.pattern);
  ASSERT_TRUE(patient.factorize(H.values));
  EXPECT_FALSE(patient.solve(b, x, 1e-18).ok);
}

TEST(ConjugateGradient, DescendsUnderNegativeCurvature) {
  for (const double shift : {-0.5, -3.0}) {
    Matrix H = spring_lattice({.nx = 8, .ny = 4, .nz = 4, .stiffness = 10});
    for (int r = 0; r < H.rows(); ++r) add_block(H.values, r, r, (shift - 1) * identity3<double>());
    const std::vector<double> b(3 * H.rows(), 1.0);  // a translation, which springs do not resist
    std::vector<double> x(b.size());
    ConjugateGradient solver;
    solver.analyze(*H.pattern);
    ASSERT_TRUE(solver.factorize(H.values));
    const SolveReport report = solver.solve(b, x, 1e-6);
    EXPECT_TRUE(report.indefinite);
    EXPECT_FALSE(report.ok);
    EXPECT_GT(dot(b, x), 0);
  }
}

TEST(ConjugateGradient, RejectsIndefiniteBlockAndStaysUsable) {
  Matrix H = spring_lattice({.nx = 3, .ny = 3, .nz = 3});
  const Mat3d saved = H.values.block[H.pattern->diagonal(7)];
  ConjugateGradient solver;
  solver.analyze(*H.pattern);
  H.values.block[H.pattern->diagonal(7)] = -1.0 * saved;
  EXPECT_FALSE(solver.factorize(H.values));
  H.values.block[H.pattern->diagonal(7)] = saved;
  ASSERT_TRUE(solver.factorize(H.values));
  const std::vector<double> b = random_vector(3 * H.rows(), 6);
  std::vector<double> x(b.size());
  EXPECT_TRUE(solver.solve(b, x, 1e-10).ok);
}

TEST(BlockInverse, ModifiedHasAbsoluteEigenvalues) {
  // Eigenvalues 3 and -1 in the x-y plane and 5 along z.
  const Mat3d A = {{1, 2, 0, 2, 1, 0, 0, 0, 5}};
  Mat3d inverse;
  ASSERT_TRUE(invert_modified(A, inverse));
  // |A| has the blocks [[2, 1], [1, 2]] and 5, with the inverses [[2, -1], [-1, 2]] / 3 and 1 / 5.
  const Mat3d expected = {{2.0 / 3, -1.0 / 3, 0, -1.0 / 3, 2.0 / 3, 0, 0, 0, 0.2}};
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(inverse.a[i], expected.a[i], 1e-15);
  EXPECT_FALSE(invert_modified({}, inverse));
  EXPECT_FALSE(invert_modified({{NAN, 0, 0, 0, 1, 0, 0, 0, 1}}, inverse));
}

TEST(ConjugateGradient, ModifiedBlocksGiveDescentForIndefiniteDiagonal) {
  Matrix H = spring_lattice({.nx = 3, .ny = 3, .nz = 3});
  Mat3d& block = H.values.block[H.pattern->diagonal(7)];
  block = -1.0 * block;
  const std::vector<double> b = random_vector(3 * H.rows(), 6);
  std::vector<double> x(b.size());
  ConjugateGradient solver(std::make_unique<BlockJacobi>(BlockJacobi::Blocks::modified));
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  const SolveReport report = solver.solve(b, x, 1e-6);
  EXPECT_TRUE(report.indefinite);
  EXPECT_GT(dot(b, x), 0);
}

TEST(ConjugateGradient, SolvesEmptySystemAndZero) {
  for (const int rows : {0, 1, 2}) {
    const Matrix H = random_dominant(rows, {}, 7);
    std::vector<double> b(3 * rows, 0.0), x(3 * rows, 1.0);
    ConjugateGradient solver;
    solver.analyze(*H.pattern);
    ASSERT_TRUE(solver.factorize(H.values));
    EXPECT_TRUE(solver.solve(b, x, 1e-10).ok);
    EXPECT_EQ(x, b);
  }
}

TEST(ConjugateGradient, RejectsNaN) {
  const Matrix H = random_dominant(4, random_couplings(4, 6, 8), 9);
  std::vector<double> b(12, std::numeric_limits<double>::quiet_NaN()), x(12);
  ConjugateGradient solver;
  solver.analyze(*H.pattern);
  ASSERT_TRUE(solver.factorize(H.values));
  const SolveReport report = solver.solve(b, x, 1e-10);
  EXPECT_FALSE(report.ok);
  EXPECT_FALSE(report.indefinite);
}

// Multigrid that counts its constructions.
class CountedMultigrid : public Multigrid {
 public:
  explicit CountedMultigrid(int& count) : count_(count) {}
  bool factorize(const BlockSparse& H) override { return ++count_, Multigrid::factorize(H); }

 private:
  int& count_;
};

struct Sequence {
  int made = 0;
  ConjugateGradient solver{std::make_unique<CountedMultigrid>(made)};
  std::vector<double> b, x;
  SolveReport report;

  explicit Sequence(const BlockPattern& pattern) : b(random_vector(3 * pattern.rows(), 11)), x(b.size()) {
    solver.analyze(pattern);
  }
  void solve(const BlockSparse& H) {
    ASSERT_TRUE(solver.factorize(H));
    report = solver.solve(b, x, 1e-8);
    EXPECT_TRUE(report.ok);
    EXPECT_LE(relative_residual(H, b, x), 1e-8 * (1 + 1e-3));
  }
};

Lattice soft(double stiffness) { return {.nx = 16, .ny = 8, .nz = 8, .stiffness = stiffness}; }

// The same lattice with springs along one plane that are a thousand times as stiff.
Matrix stiffened_lattice() {
  Matrix H = spring_lattice(soft(100));
  for (int row = 1; row < H.rows(); ++row)
    for (int64_t s = H.pattern->row_start[row]; s < H.pattern->diagonal(row); ++s) {
      const int column = H.pattern->column[s];
      if (H.pattern->rest_position[row][0] != 8 || H.pattern->rest_position[column][0] != 8) continue;
      const Mat3d K = -999.0 * H.values.block[s];
      add_block(H.values, row, row, K);
      add_block(H.values, column, column, K);
      add_block(H.values, row, column, -1.0 * K);
    }
  return H;
}

TEST(ConjugateGradient, ReusesMultigridForTheNextMatrix) {
  const Matrix first = spring_lattice(soft(100)), second = spring_lattice(soft(110));
  Sequence sequence(*first.pattern);
  sequence.solve(first.values);
  const std::vector<double> before = sequence.x;
  BlockSparse H(*first.pattern);
  H.block = second.values.block;
  sequence.solve(H);
  EXPECT_EQ(sequence.made, 1);
  EXPECT_NE(sequence.x, before);
}

TEST(ConjugateGradient, RebuildsMultigridWhenIterationsGrow) {
  const Matrix first = spring_lattice(soft(100));
  BlockSparse stiffened(*first.pattern);
  stiffened.block = stiffened_lattice().values.block;
  Sequence sequence(*first.pattern);
  sequence.solve(first.values);
  const int few = sequence.report.iterations;
  sequence.solve(stiffened);
  const int many = sequence.report.iterations;
  EXPECT_EQ(sequence.made, 1);
  EXPECT_GT(many, 1.3 * few);
  sequence.solve(stiffened);
  EXPECT_EQ(sequence.made, 2);
  EXPECT_LT(sequence.report.iterations, many / 1.3);
  sequence.solve(stiffened);
  EXPECT_EQ(sequence.made, 2);
}

TEST(ConjugateGradient, NewSequenceIsIndependentOfEarlierOnes) {
  const Matrix first = spring_lattice(soft(100));
  BlockSparse second(*first.pattern), stiffened(*first.pattern);
  second.block = spring_lattice(soft(110)).values.block;
  stiffened.block = stiffened_lattice().values.block;
  Sequence old(*first.pattern), fresh(*first.pattern);
  old.solve(first.values);
  old.solve(second);  // with the preconditioner of the first matrix
  const std::vector<double> dependent = old.x;
  old.solver.begin();
  fresh.solver.begin();
  for (const BlockSparse* H : {&second, &stiffened, &second}) {
    old.solve(*H);
    fresh.solve(*H);
    EXPECT_EQ(old.x, fresh.x);
    EXPECT_EQ(old.report.iterations, fresh.report.iterations);
    EXPECT_EQ(old.made, fresh.made + 1);
    if (H == &second) {
      EXPECT_NE(dependent, old.x);
    }
  }
}

TEST(ConjugateGradient, ReportsWorkAndDescendsAtDeadline) {
  const Matrix H = spring_lattice(soft(1e4));
  const std::vector<double> b = random_vector(3 * H.rows(), 12);
  double now = 0;
  const WallClock clock = [&] { return now++; };
  for (const bool with_multigrid : {false, true})
    for (const double seconds : {-1.0, 0.5, 3.5}) {
      ConjugateGradient solver;
      if (with_multigrid) solver = ConjugateGradient(std::make_unique<Multigrid>());
      solver.analyze(*H.pattern);
      ASSERT_TRUE(solver.factorize(H.values));
      solver.set_stop(StopToken(clock, seconds));
      std::vector<double> x(b.size(), 99.0);
      const SolveReport report = solver.solve(b, x, 1e-10);
      EXPECT_TRUE(report.stopped);
      EXPECT_FALSE(report.ok);
      EXPECT_EQ(report.iterations, seconds < 1 ? 1 : 4);  // the clock is read before each iteration except the first
      EXPECT_EQ(report.products, report.iterations);
      EXPECT_EQ(report.cycles, with_multigrid ? report.iterations + 1 : 0);
      EXPECT_NEAR(report.relative_residual, relative_residual(H.values, b, x), 1e-12);  // the recurrence drifts
      EXPECT_GT(dot(b, x), 0);

      solver.set_stop({});
      EXPECT_TRUE(solver.solve(b, x, 1e-10).ok);
    }
}

TEST(ConjugateGradient, IsBitReproducibleForAnyThreadCount) {
  const Matrix H = spring_lattice({.nx = 30, .ny = 14, .nz = 14, .stiffness = 50});  // 6 975 vertices: several chunks
  const std::vector<double> b = random_vector(3 * H.rows(), 10);
  const int threads = thread_count();
  std::vector<double> expected;
  for (const int count : {1, 2, 3, 8}) {
    set_thread_count(count);
    ConjugateGradient solver;
    solver.analyze(*H.pattern);
    ASSERT_TRUE(solver.factorize(H.values));
    std::vector<double> x(b.size());
    EXPECT_TRUE(solver.solve(b, x, 1e-8).ok);
    if (expected.empty()) expected = x;
    EXPECT_EQ(x, expected) << count << " threads";
  }
  set_thread_count(threads);
}

}  // namespace
}  // namespace aspic
