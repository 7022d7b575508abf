#include "linalg/block_sparse.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "base/check.h"
#include "base/parallel.h"
#include "math/lanes.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr int kPrefetchAhead = 4096;  // bytes

// Rows per task of a product. Blocks between tasks are read twice, so tasks are large, but small enough to occupy
// several threads and their caches.
int rows_per_task(int rows) { return std::clamp(rows / 16, 512, 8192); }

// Converts counts, stored one place to the right, into offsets.
void accumulate(std::vector<int64_t>& start) { std::partial_sum(start.begin(), start.end(), start.begin()); }

// Columns of the lower triangle, grouped by row; includes repeats and the diagonal.
struct Buckets {
  std::vector<int64_t> start;
  std::vector<int> column;
};

Buckets sort_by_row(int rows, const Couplings& couplings) {
  Buckets buckets{std::vector<int64_t>(rows + 1, 1), {}};
  buckets.start[0] = 0;
  for (const auto& [i, j] : couplings) {
    ASPIC_CHECK(0 <= i && i < rows && 0 <= j && j < rows);
    if (i != j) ++buckets.start[std::max(i, j) + 1];
  }
  accumulate(buckets.start);
  buckets.column.resize(buckets.start[rows]);
  std::vector<int64_t> next(buckets.start.begin(), buckets.start.end() - 1);
  for (const auto& [i, j] : couplings)
    if (i != j) buckets.column[next[std::max(i, j)]++] = std::min(i, j);
  for (int row = 0; row < rows; ++row) buckets.column[next[row]] = row;
  return buckets;
}

// Sorts the columns of each row and returns the number of distinct ones.
std::vector<int64_t> sort_columns(Buckets& buckets) {
  const int rows = static_cast<int>(buckets.start.size()) - 1;
  std::vector<int64_t> distinct(rows + 1, 0);
  parallel_chunks(rows, [&](int first, int last) {
    for (int row = first; row < last; ++row) {
      const auto begin = buckets.column.begin() + buckets.start[row],
                 end = buckets.column.begin() + buckets.start[row + 1];
      std::sort(begin, end);
      distinct[row + 1] = std::unique(begin, end) - begin;
    }
  });
  return distinct;
}

void add_upper_view(BlockPattern& pattern) {
  const int rows = pattern.rows();
  const int64_t off_diagonal = pattern.block_count() - rows;
  pattern.upper_start.assign(rows + 1, 0);
  pattern.upper_row.resize(off_diagonal);
  pattern.upper_slot.resize(off_diagonal);
  for (int row = 0; row < rows; ++row)
    for (int64_t s = pattern.row_start[row]; s < pattern.diagonal(row); ++s)
      ++pattern.upper_start[pattern.column[s] + 1];
  accumulate(pattern.upper_start);
  std::vector<int64_t> next(pattern.upper_start.begin(), pattern.upper_start.end() - 1);
  for (int row = 0; row < rows; ++row)
    for (int64_t s = pattern.row_start[row]; s < pattern.diagonal(row); ++s) {
      const int64_t place = next[pattern.column[s]]++;
      pattern.upper_row[place] = row;
      pattern.upper_slot[place] = s;
    }
}

uint64_t next_version() {
  static std::atomic<uint64_t> version = 0;
  return ++version;
}

using QuadD = Quad<double>;

// Returns A x without reading past the block.
QuadD careful_product(const Mat3d& A, const double* x) {
  const Vec3d y = A * Vec3d{{x[0], x[1], x[2]}};
  return load3(y.a);
}

}  // namespace

int64_t BlockPattern::slot(int row, int col) const {
  ASPIC_CHECK(0 <= col && col <= row && row < rows());
  const auto begin = column.begin() + row_start[row], end = column.begin() + row_start[row + 1];
  const auto found = std::lower_bound(begin, end, col);
  ASPIC_CHECK(found != end && *found == col);
  return found - column.begin();
}

BlockPattern make_pattern(int rows, Couplings couplings) {
  ASPIC_CHECK(rows >= 0);
  Buckets buckets = sort_by_row(rows, couplings);
  Couplings().swap(couplings);  // frees memory for large meshes
  BlockPattern pattern;
  pattern.row_start = sort_columns(buckets);
  accumulate(pattern.row_start);
  pattern.column.resize(pattern.row_start[rows]);
  for (int row = 0; row < rows; ++row) {
    const int64_t count = pattern.row_start[row + 1] - pattern.row_start[row];
    std::copy_n(buckets.column.begin() + buckets.start[row], count, pattern.column.begin() + pattern.row_start[row]);
  }
  add_upper_view(pattern);
  pattern.version = next_version();
  return pattern;
}

void BlockSparse::set_zero() {
  auto clear_rows = [this](int first, int last) {
    const auto begin = block.begin();
    std::fill(begin + pattern->row_start[first], begin + pattern->row_start[last], Mat3d{});
  };
  parallel_chunks(pattern->rows(), clear_rows);
  stencils.clear();
}

void BlockSparse::multiply(std::span<const double> x, std::span<double> y) const {
  const BlockPattern& p = *pattern;
  const int rows = p.rows();
  ASPIC_CHECK(x.size() == 3 * static_cast<size_t>(rows) && y.size() == x.size() && (rows == 0 || x.data() != y.data()));
  const int size = rows_per_task(rows);
  // A block whose row and column belong to one task is read once and used twice. Both tasks read a block between them.
  auto rows_of_task = [&](int task) {
    const int first = task * size, last = std::min(rows, first + size);
    const auto at = [](auto& v, int row) { return &v[3 * static_cast<size_t>(row)]; };
    for (int row = first; row < last; ++row) {
      for (int64_t k = p.row_start[row]; k < p.row_start[row + 1]; ++k)
        __builtin_prefetch(reinterpret_cast<const char*>(&block[k]) + kPrefetchAhead);
      const QuadD x_row = load3(at(x, row));
      const int64_t diagonal = p.diagonal(row);
      QuadD sum = careful_product(block[diagonal], at(x, row));
      int64_t s = p.row_start[row];
      for (; p.column[s] < first; ++s) sum += product(block[s].a, at(x, p.column[s]));
      for (; s < diagonal; ++s) {
        sum += product(block[s].a, at(x, p.column[s]));
        double* y_column = at(y, p.column[s]);
        store3(load3(y_column) + transposed_product(block[s].a, x_row), y_column);
      }
      for (int64_t u = p.upper_start[row + 1] - 1; u >= p.upper_start[row] && p.upper_row[u] >= last; --u)
        sum += transposed_product(block[p.upper_slot[u]].a, load3(at(x, p.upper_row[u])));
      store3(sum, at(y, row));
    }
  };
  parallel_for((rows + size - 1) / size, rows_of_task);
  for (const Stencil& stencil : stencils)
    for_each_block(stencil, [&](int i, int j, const Mat3d& K) {
      add_vec(K * vec_at(x, j), i, y);
      add_vec(transpose(K) * vec_at(x, i), j, y);
    });
}

}  // namespace aspic
