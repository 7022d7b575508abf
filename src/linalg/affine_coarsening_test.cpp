#include "linalg/affine_coarsening.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "base/parallel.h"
#include "linalg/matrices_test.h"

namespace aspic {
namespace {

using namespace test;
using Dense = Eigen::MatrixXd;

std::vector<FourValues> values_of(const std::vector<Vec3d>& position) {
  std::vector<FourValues> value;
  for (const Vec3d& X : position) value.push_back({1, X[0], X[1], X[2]});
  return value;
}

struct TwoLevels {
  AffineCoarsening fine, coarse;
};

std::vector<Vec3d> centers(const Aggregates& aggregates, const std::vector<Vec3d>& position) {
  std::vector<Vec3d> center(aggregates.count());
  for (int a = 0; a < aggregates.count(); ++a)
    for (const int v : aggregates.members(a))
      center[a] = center[a] + (1.0 / static_cast<double>(aggregates.members(a).size())) * position[v];
  return center;
}

TwoLevels two_levels(const BlockPattern& pattern, std::span<const char> excluded = {}) {
  const Graph graph = graph_of(pattern);
  const Aggregates aggregates = make_aggregates({graph, pattern.rest_position, {}, excluded, 12});
  TwoLevels levels;
  levels.fine = make_affine_coarsening(graph, aggregates, 1, values_of(pattern.rest_position));
  const std::vector<Vec3d> position = centers(aggregates, pattern.rest_position);
  const Aggregates of_aggregates = make_aggregates({levels.fine.graph, position, {}, {}, 6});
  levels.coarse = make_affine_coarsening(levels.fine.graph, of_aggregates, 4, levels.fine.coarse_value);
  return levels;
}

// The prolongation matrix, with 3 rows per row of the fine matrix.
Dense prolongation(const AffineCoarsening& c) {
  const int rows = static_cast<int>(c.weight.size());
  Dense P = Dense::Zero(3 * rows, 12 * c.count());
  for (int i = 0; i < rows; ++i)
    for (int m = 0; m < 4; ++m)
      for (int k = 0; k < 3; ++k)
        if (c.aggregate[i] >= 0) P(3 * i + k, 3 * (4 * c.aggregate[i] + m) + k) = c.weight[i][m];
  return P;
}

Dense full(const BlockSparse& H) {
  const std::vector<double> entries = dense(H);
  return Eigen::Map<const Dense>(entries.data(), 3 * H.pattern->rows(), 3 * H.pattern->rows());
}

// P' H P, where dropped rows are those of the identity.
Dense restricted(const AffineCoarsening& c, const BlockSparse& H) {
  const Dense P = prolongation(c);
  Dense A = P.transpose() * full(H) * P;
  for (int i = 0; i < 4 * c.count(); ++i)
    if (c.coarse_value[i][i % 4] == 0)
      for (int k = 0; k < 3; ++k) A(3 * i + k, 3 * i + k) += 1;
  return A;
}

// Returns the largest part of the values outside of the span of the coarse functions, relative to the largest value.
double misfit(const AffineCoarsening& c, const std::vector<FourValues>& value) {
  double worst = 0, largest = 0;
  for (size_t i = 0; i < value.size(); ++i)
    for (int n = 0; n < 4 && c.aggregate[i] >= 0; ++n) {
      double sum = 0;
      for (int m = 0; m < 4; ++m) sum += c.weight[i][m] * c.coarse_value[4 * c.aggregate[i] + m][n];
      worst = std::max(worst, std::abs(sum - value[i][n]));
      largest = std::max(largest, std::abs(value[i][n]));
    }
  return worst / largest;
}

int functions(const AffineCoarsening& c, int a) {
  int count = 0;
  for (int m = 0; m < 4; ++m) count += c.coarse_value[4 * a + m][m] != 0;
  return count;
}

void expect_orthonormal(const AffineCoarsening& c) {
  for (int a = 0; a < c.count(); ++a)
    for (int m = 0; m < 4; ++m)
      for (int n = 0; n <= m; ++n) {
        double sum = 0;
        for (const int i : c.rows_of(a)) sum += c.weight[i][m] * c.weight[i][n];
        const double expected = m == n && c.coarse_value[4 * a + m][m] != 0 ? 1 : 0;
        EXPECT_NEAR(sum, expected, 1e-14) << "functions " << m << ", " << n << " of aggregate " << a;
      }
}

Matrix uneven_lattice() {
  Matrix H = spring_lattice({.nx = 9, .ny = 4, .nz = 4, .stiffness = 100});
  const std::vector<double> random = random_vector(3 * H.rows(), 1);
  for (int v = 0; v < H.rows(); ++v)
    for (int k = 0; k < 3; ++k) H.pattern->rest_position[v][k] += 0.3 * random[3 * v + k] + 20;  // off the origin
  return H;
}

TEST(AffineCoarsening, HasOrthonormalWeightsOnBothLevels) {
  const Matrix H = uneven_lattice();
  const TwoLevels levels = two_levels(*H.pattern);
  ASSERT_GT(levels.coarse.count(), 1);
  expect_orthonormal(levels.fine);
  expect_orthonormal(levels.coarse);
  for (int a = 0; a < levels.fine.count(); ++a) EXPECT_EQ(functions(levels.fine, a), 4);
  for (int a = 0; a < levels.coarse.count(); ++a) EXPECT_EQ(functions(levels.coarse, a), 4);
}

TEST(AffineCoarsening, ReproducesEveryAffineDisplacementOnBothLevels) {
  const Matrix H = uneven_lattice();
  const auto [fine, coarse] = two_levels(*H.pattern);
  EXPECT_LT(misfit(fine, values_of(H.pattern->rest_position)), 1e-12);
  EXPECT_LT(misfit(coarse, fine.coarse_value), 1e-12);
  // The same for both levels: u(X) = A X + t at the vertices is P Q times its values on the coarsest rows.
  const std::vector<double> affine = random_vector(12, 2);  // column m: factor of function m of (1, X, Y, Z)
  const auto displacement = [&](const std::vector<FourValues>& value) {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * static_cast<int>(value.size()));
    for (size_t i = 0; i < value.size(); ++i)
      for (int m = 0; m < 4; ++m)
        for (int k = 0; k < 3; ++k) u[3 * i + k] += value[i][m] * affine[3 * m + k];
    return u;
  };
  const Eigen::VectorXd expected = displacement(values_of(H.pattern->rest_position));
  const Eigen::VectorXd u = prolongation(fine) * (prolongation(coarse) * displacement(coarse.coarse_value));
  EXPECT_LT((u - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
}

TEST(AffineCoarsening, DropsLinearlyDependentFunctions) {
  struct Case {
    std::vector<Vec3d> position;
    int functions;
  };
  const auto at = [](double i, double j, double k) {  // on a grid that is sheared, shifted and rounded
    return Vec3d{{3.1 + 0.7 * i - 0.3 * j, 1.3 + 0.3 * i + 0.7 * j + 0.1 * k, 2.7 + 0.2 * i - 0.1 * j + 0.9 * k}};
  };
  const Vec3d o = at(0, 0, 0), x = at(1, 0, 0), y = at(0, 1, 0), z = at(0, 0, 1), xy = at(1, 1, 0), far = at(2, 2, 2);
  std::vector<Vec3d> sheet;
  for (const double u : random_vector(20, 3)) sheet.push_back(at(u, u * u, 0));
  for (const auto& [position, count] :
       {Case{{o}, 1}, Case{{o, x}, 2}, Case{{o, far}, 2}, Case{{o, o, o}, 1}, Case{{o, x, y, xy}, 3}, Case{sheet, 3},
        Case{{o, x, far}, 3}, Case{{o, x, y, z}, 4}, Case{{o, x, y, z, xy, far}, 4}}) {
    const int rows = static_cast<int>(position.size());
    Couplings path;
    for (int v = 1; v < rows; ++v) path.emplace_back(v, v - 1);
    const Graph graph = graph_of(make_pattern(rows, path));
    const Aggregates aggregates = make_aggregates({.graph = graph, .position = position});
    ASSERT_EQ(aggregates.count(), 1);
    const AffineCoarsening c = make_affine_coarsening(graph, aggregates, 1, values_of(position));
    EXPECT_EQ(functions(c, 0), count) << rows << " vertices";
    expect_orthonormal(c);
    EXPECT_LT(misfit(c, values_of(position)), 1e-12);
    for (int m = 0; m < 4; ++m)  // the value of a dropped function is also zero on the next level
      for (int n = 0; n < 4; ++n)
        if (c.coarse_value[m][m] == 0) {
          EXPECT_EQ(c.coarse_value[m][n], 0);
        }
    const AffineCoarsening next = make_affine_coarsening(
        c.graph, make_aggregates({.graph = c.graph, .position = std::vector<Vec3d>(1)}), 4, c.coarse_value);
    EXPECT_EQ(functions(next, 0), count);
    expect_orthonormal(next);
  }
}

TEST(AffineCoarsening, HasRowsAndPatternOfItsAggregates) {
  const Matrix H = uneven_lattice();
  std::vector<char> excluded(H.rows(), 0);
  excluded[5] = excluded[100] = 1;
  const AffineCoarsening c = two_levels(*H.pattern, excluded).fine;
  EXPECT_EQ(c.aggregate[5], -1);
  EXPECT_EQ(c.row.size(), static_cast<size_t>(H.rows()) - 2);
  for (int a = 0; a < c.count(); ++a) {
    for (const int i : c.rows_of(a)) EXPECT_EQ(c.aggregate[i], a);
    int expected = 4 * 5 / 2;  // the aggregate's own blocks and all 16 for each aggregate before it
    for (const int b : c.graph.around(a)) expected += b < a ? 16 : 0;
    EXPECT_EQ(c.pattern.row_start[4 * a + 4] - c.pattern.row_start[4 * a], expected);
  }
}

void expect_product(const AffineCoarsening& c, const BlockSparse& fine, BlockSparse& coarse) {
  MatrixRestriction restriction;
  restriction.reserve(c);
  const int threads = thread_count();
  LargeVector<Mat3d> first;
  for (const int count : {1, 2, 3, 8}) {
    set_thread_count(count);
    for (Mat3d& block : coarse.block) block = 7.0 * identity3<double>();  // must be overwritten
    restriction.run(c, fine, coarse);
    if (first.empty()) first = coarse.block;
    for (size_t s = 0; s < first.size(); ++s)
      for (int k = 0; k < 9; ++k) ASSERT_EQ(coarse.block[s].a[k], first[s].a[k]) << count << " threads";
  }
  set_thread_count(threads);
  const Dense expected = restricted(c, fine);
  // Weights are at most one, so each entry is at most the sum of all entries of H between two aggregates.
  const double bound = 1e-15 * 100 * full(fine).cwiseAbs().rowwise().sum().maxCoeff();
  EXPECT_LT((full(coarse) - expected).cwiseAbs().maxCoeff(), bound);
}

TEST(MatrixRestriction, EqualsDenseProductOnBothLevels) {
  for (const bool has_pins : {false, true}) {
    Matrix H = uneven_lattice();
    std::vector<char> excluded(H.rows(), 0);
    for (int row = 0; has_pins && row < H.rows(); row += 31) excluded[row] = 1, pin(H.values, row);
    const TwoLevels levels = two_levels(*H.pattern, excluded);
    BlockSparse once(levels.fine.pattern), twice(levels.coarse.pattern);
    expect_product(levels.fine, H.values, once);
    expect_product(levels.coarse, once, twice);
  }
}

TEST(MatrixRestriction, EqualsDenseProductOnRandomMatrices) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    Matrix H = random_dominant(80, random_couplings(80, 90, seed), seed);  // uncoupled rows form aggregates of one
    const std::vector<double> random = random_vector(240, seed + 10);
    for (int v = 0; v < 80; ++v)  // in a plane
      H.pattern->rest_position.push_back({{random[3 * v], random[3 * v + 1], 0.5}});
    const TwoLevels levels = two_levels(*H.pattern);
    BlockSparse once(levels.fine.pattern), twice(levels.coarse.pattern);
    int dropped = 0;
    for (int a = 0; a < levels.fine.count(); ++a) dropped += 4 - functions(levels.fine, a);
    EXPECT_GE(dropped, levels.fine.count());
    expect_product(levels.fine, H.values, once);
    expect_product(levels.coarse, once, twice);
    EXPECT_EQ(Eigen::LLT<Dense>(full(twice)).info(), Eigen::Success);
  }
}

}  // namespace
}  // namespace aspic
