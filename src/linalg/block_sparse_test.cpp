#include "linalg/block_sparse.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <set>

#include "base/parallel.h"
#include "linalg/matrices_test.h"

namespace aspic {
namespace {

using namespace test;

TEST(BlockPattern, HasEachCouplingOnceAndAllDiagonals) {
  const Couplings couplings = random_couplings(50, 400, 1);
  const BlockPattern p = make_pattern(50, couplings);
  std::set<std::pair<int, int>> expected, found;
  for (int r = 0; r < 50; ++r) expected.emplace(r, r);
  for (const auto& [i, j] : couplings) expected.emplace(std::max(i, j), std::min(i, j));
  for (int r = 0; r < p.rows(); ++r) {
    EXPECT_TRUE(std::is_sorted(p.column.begin() + p.row_start[r], p.column.begin() + p.row_start[r + 1]));
    EXPECT_EQ(p.column[p.diagonal(r)], r);
    for (int64_t s = p.row_start[r]; s < p.row_start[r + 1]; ++s) found.emplace(r, p.column[s]);
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(p.block_count(), static_cast<int64_t>(expected.size()));
}

TEST(BlockPattern, SlotFindsEachBlock) {
  const BlockPattern p = make_pattern(40, random_couplings(40, 200, 2));
  for (int r = 0; r < p.rows(); ++r)
    for (int64_t s = p.row_start[r]; s < p.row_start[r + 1]; ++s) EXPECT_EQ(p.slot(r, p.column[s]), s);
}

TEST(BlockPattern, UpperViewHasSameBlocks) {
  const BlockPattern p = make_pattern(60, random_couplings(60, 300, 3));
  EXPECT_EQ(p.upper_start.back(), p.block_count() - p.rows());
  for (int c = 0; c < p.rows(); ++c)
    for (int64_t u = p.upper_start[c]; u < p.upper_start[c + 1]; ++u) {
      EXPECT_GT(p.upper_row[u], c);
      EXPECT_EQ(p.upper_slot[u], p.slot(p.upper_row[u], c));
    }
}

TEST(BlockPattern, IgnoresOrderAndRepeatsOfCouplings) {
  Couplings couplings = random_couplings(30, 100, 4);
  const BlockPattern p = make_pattern(30, couplings);
  std::reverse(couplings.begin(), couplings.end());
  for (auto& [i, j] : couplings) std::swap(i, j);
  couplings.insert(couplings.end(), couplings.begin(), couplings.begin() + 50);
  const BlockPattern q = make_pattern(30, couplings);
  EXPECT_EQ(p.row_start, q.row_start);
  EXPECT_EQ(p.column, q.column);
  EXPECT_EQ(p.upper_slot, q.upper_slot);
}

TEST(BlockPattern, VersionsDiffer) { EXPECT_NE(make_pattern(3, {}).version, make_pattern(3, {}).version); }

TEST(BlockPattern, MayBeEmpty) {
  const BlockPattern p = make_pattern(0, {});
  EXPECT_EQ(p.rows(), 0);
  EXPECT_EQ(p.block_count(), 0);
  BlockSparse H(p);
  H.set_zero();
  H.multiply({}, {});
}

TEST(BlockSparse, ProductEqualsThatOfDenseMatrix) {
  for (const int rows : {1, 2, 3, 17, 200}) {
    const Matrix H = random_dominant(rows, random_couplings(rows, 5 * rows, 5), 6);
    const std::vector<double> x = random_vector(3 * rows, 7);
    std::vector<double> y(x.size());
    H.values.multiply(x, y);
    const std::vector<double> entries = dense(H.values);
    const Eigen::Map<const Eigen::MatrixXd> A(entries.data(), 3 * rows, 3 * rows);
    const Eigen::Map<const Eigen::VectorXd> X(x.data(), 3 * rows), Y(y.data(), 3 * rows);
    EXPECT_EQ(A, A.transpose());
    const Eigen::VectorXd expected = A * X;
    // Each entry sums at most 3 rows products, so its error is below 3 rows eps |A| |x|.
    const double bound = 3 * rows * 2.3e-16 * (A.cwiseAbs() * X.cwiseAbs()).maxCoeff();
    EXPECT_LE((Y - expected).cwiseAbs().maxCoeff(), bound);
  }
}

// Product computed block by block, and the sum of the absolute values of its terms.
struct PlainProduct {
  std::vector<double> y, magnitude;
  PlainProduct(const BlockSparse& H, const std::vector<double>& x) : y(x.size()), magnitude(x.size()) {
    const BlockPattern& p = *H.pattern;
    for (int row = 0; row < p.rows(); ++row)
      for (int64_t s = p.row_start[row]; s < p.row_start[row + 1]; ++s)
        for (int k = 0; k < 9; ++k) {
          const size_t i = 3 * static_cast<size_t>(row) + k % 3, j = 3 * static_cast<size_t>(p.column[s]) + k / 3;
          add(i, H.block[s].a[k] * x[j]);
          if (p.column[s] != row) add(j, H.block[s].a[k] * x[i]);
        }
  }

 private:
  void add(size_t i, double term) { y[i] += term, magnitude[i] += std::abs(term); }
};

// A task processes 512 rows, or a sixteenth of them, or 8192: tests couplings within, between and far from tasks.
TEST(BlockSparse, ProductMatchesBlocksForAnyThreadCount) {
  const int threads = thread_count();
  for (const int rows : {1, 511, 512, 513, 1023, 1024, 1025, 2 * 8192 + 1, 16 * 8192, 16 * 8192 + 1}) {
    Couplings couplings = random_couplings(rows, rows, 11);
    for (int row = 1; row < rows; ++row) couplings.emplace_back(row, row - 1);
    const Matrix H = random_dominant(rows, couplings, 12);
    const std::vector<double> x = random_vector(3 * static_cast<size_t>(rows), 13);
    const PlainProduct plain(H.values, x);
    std::vector<double> first;
    for (const int count : {1, 2, 3, 8}) {
      set_thread_count(count);
      std::vector<double> y(x.size(), std::numeric_limits<double>::quiet_NaN());  // overwritten
      H.values.multiply(x, y);
      if (first.empty()) first = y;
      ASSERT_TRUE(y == first) << rows << " rows, " << count << " threads";
    }
    for (size_t i = 0; i < x.size(); ++i)  // rows of fewer than 20 blocks: 60 terms, twice
      ASSERT_NEAR(first[i], plain.y[i], 120 * 1.1e-16 * plain.magnitude[i]) << rows << " rows, entry " << i;
  }
  set_thread_count(threads);
}

TEST(BlockSparse, ProductDoesNotReadPastLastBlock) {
  for (const int rows : {1, 2, 513}) {
    Matrix H = random_dominant(rows, random_couplings(rows, 4 * rows, 14), 15);
    const std::vector<double> x = random_vector(3 * rows, 16);
    std::vector<double> expected(x.size()), y(x.size());
    H.values.multiply(x, expected);
    H.values.block.push_back(std::numeric_limits<double>::quiet_NaN() * identity3<double>());
    H.values.multiply(x, y);
    EXPECT_EQ(y, expected);
  }
}

TEST(BlockSparse, SetZeroClearsEveryBlock) {
  Matrix H = random_dominant(5000, random_couplings(5000, 9000, 8), 9);
  H.values.set_zero();
  for (const Mat3d& block : H.values.block) ASSERT_EQ(squared_norm(block), 0);
}

TEST(BlockSparse, ProductIsBitReproducibleForAnyThreadCount) {
  const Matrix H = spring_lattice({.nx = 30, .ny = 14, .nz = 14});
  const std::vector<double> x = random_vector(3 * H.rows(), 10);
  const int threads = thread_count();
  std::vector<double> expected(x.size()), y(x.size());
  set_thread_count(1);
  H.values.multiply(x, expected);
  for (const int count : {2, 3, 8}) {
    set_thread_count(count);
    H.values.multiply(x, y);
    EXPECT_EQ(y, expected) << count << " threads";
  }
  set_thread_count(threads);
}

}  // namespace
}  // namespace aspic
