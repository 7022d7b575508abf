#include "linalg/dense_cholesky.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "base/parallel.h"
#include "math/pack.h"

namespace aspic {
namespace {

using Product = DenseCholesky::Product;
using std::ptrdiff_t;

// Register tile of the product: 2 packs by 6 columns, 12 accumulators. Cache blocks follow [Goto and van de Geijn
// 2008].
constexpr int kTileRows = 2 * kPackWidth;
constexpr int kTileColumns = 6;
constexpr int kDepthBlock = 192;
constexpr int kRowBlock = 6 * 16;      // a multiple of kTileRows for every pack width
constexpr int kColumnBlock = 6 * 128;  // a multiple of kTileColumns and of kTileRows
constexpr int kPackedFromRows = 192;   // smaller products do not pack A
constexpr double kParallelFrom = 3e5;  // multiply-adds; about 10 us on one core
constexpr int kPackedColumns = 96;     // columns per task; a multiple of kTileColumns
constexpr int kNarrowRows = 256;       // rows of a narrow panel per task; a multiple of every pack width
constexpr int kBaseColumns = 12;       // narrower panels are factorized directly
static_assert(LowerMatrix::kStrip % kTileColumns == 0 && LowerMatrix::kStrip % kTileRows == 0);
static_assert(kRowBlock % kTileRows == 0 && kReadAhead >= kTileRows);

Pack load(const double* p) {
  Pack x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
void store(double* p, Pack x) { std::memcpy(p, &x, sizeof x); }

struct Tile {
  Pack sum[kTileColumns][2];
};

// Returns sum_p A(:, p) B(:, p)' for kTileRows rows of A and kTileColumns rows of B.
inline Tile product(const double* A, ptrdiff_t A_stride, const double* B, ptrdiff_t B_stride, int depth) {
  Tile t;
  for (auto& column : t.sum) column[0] = column[1] = Pack(0.0);
  for (int p = 0; p < depth; ++p, A += A_stride, B += B_stride) {
    const Pack a0 = load(A), a1 = load(A + kPackWidth);
    for (int c = 0; c < kTileColumns; ++c) {
      const Pack b(B[c]);
      t.sum[c][0] += a0 * b;
      t.sum[c][1] += a1 * b;
    }
  }
  return t;
}

template <Product kind>
void put_whole(const Tile& t, double* C, ptrdiff_t stride) {
  for (int c = 0; c < kTileColumns; ++c, C += stride) {
    store(C, kind == Product::set ? -t.sum[c][0] : load(C) - t.sum[c][0]);
    store(C + kPackWidth, kind == Product::set ? -t.sum[c][1] : load(C + kPackWidth) - t.sum[c][1]);
  }
}

struct Part {  // part of a tile: entries in the first `rows` rows and `columns` columns with row + shift >= column
  int rows, columns, shift;
};

template <Product kind>
void put_part(const Tile& t, double* C, ptrdiff_t stride, Part part) {
  double sum[kTileRows];
  for (int c = 0; c < part.columns; ++c, C += stride) {
    store(sum, t.sum[c][0]);
    store(sum + kPackWidth, t.sum[c][1]);
    for (int r = std::max(0, c - part.shift); r < part.rows; ++r) C[r] = kind == Product::set ? -sum[r] : C[r] - sum[r];
  }
}

struct Operand {  // strip s of the rows starts at data + s * strip_step; its columns are `stride` apart
  const double* data;
  ptrdiff_t strip_step, stride;
  int columns;
};

struct Block {
  int row, column, rows, columns;
};

// Computes C -= A B' or C = -A B' on the tiles of one cache block of C.
template <Product kind>
void put_block(Operand A, Operand B, LowerMatrix C, Block block) {
  const auto [row, column, rows, columns] = block;
  const int shift = row - column;
  for (int j = 0; j < columns; j += kTileColumns) {
    const double* b = B.data + j / kTileColumns * B.strip_step;
    double* const C_column = C.column(column + j) + row;
    const ptrdiff_t stride = C.stride(column + j);
    const int first = std::max(0, (j - shift) / kTileRows * kTileRows);
    for (int i = first; i < rows; i += kTileRows) {
      if (i + kTileRows - 1 + shift < j) continue;
      const Tile t = product(A.data + i / kTileRows * A.strip_step, A.stride, b, B.stride, A.columns);
      double* c = C_column + i;
      const int tile_rows = std::min(kTileRows, rows - i), tile_columns = std::min(kTileColumns, columns - j);
      const bool whole = tile_rows == kTileRows && tile_columns == kTileColumns && i + shift >= j + kTileColumns - 1;
      if (whole) {
        put_whole<kind>(t, c, stride);
      } else {
        put_part<kind>(t, c, stride, {tile_rows, tile_columns, i + shift - j});
      }
    }
  }
}

void put_block(Product kind, Operand A, Operand B, LowerMatrix C, Block block) {
  if (kind == Product::set) return put_block<Product::set>(A, B, C, block);
  put_block<Product::subtract>(A, B, C, block);
}

// Copies strips of `strip` rows so that each is contiguous. Pads the last strip with zeros.
template <int strip>
void pack_strips(const double* A, ptrdiff_t stride, int rows, int depth, double* packed) {
  int i = 0;
  for (; i + strip <= rows; i += strip)
    for (int p = 0; p < depth; ++p, packed += strip) std::memcpy(packed, A + i + p * stride, strip * sizeof(double));
  if (i == rows) return;
  for (int p = 0; p < depth; ++p, packed += strip) {
    std::copy_n(A + i + p * stride, rows - i, packed);
    std::fill(packed + rows - i, packed + strip, 0.0);
  }
}

// Unblocked Cholesky of a small square; reciprocal[j] = 1 / L(j, j).
bool factorize_square(double* A, int n, ptrdiff_t stride, double* reciprocal) {
  for (int j = 0; j < n; ++j) {
    double pivot = A[j + j * stride];
    for (int k = 0; k < j; ++k) pivot -= A[j + k * stride] * A[j + k * stride];
    if (!(pivot > 0) || !std::isfinite(pivot)) return false;
    A[j + j * stride] = std::sqrt(pivot);
    reciprocal[j] = 1 / A[j + j * stride];
    for (int i = j + 1; i < n; ++i) {
      double sum = A[i + j * stride];
      for (int k = 0; k < j; ++k) sum -= A[i + k * stride] * A[j + k * stride];
      A[i + j * stride] = sum * reciprocal[j];
    }
  }
  return true;
}

// Solves X L' = B for T = Pack (kPackWidth rows at once) or double (one row). The row is held in registers.
template <class T, int n, class Load, class Store>
inline void solve_row(const double* L, ptrdiff_t stride, const double* reciprocal, Load get, Store put) {
  T x[n];
  for (int j = 0; j < n; ++j) {
    x[j] = get(j);
    for (int k = 0; k < j; ++k) x[j] = x[j] - x[k] * T(L[j + k * stride]);
    x[j] = x[j] * T(reciprocal[j]);
    put(j, x[j]);
  }
}

template <int n>
bool factorize_narrow(double* A, int rows, ptrdiff_t stride) {
  double reciprocal[n];
  if (!factorize_square(A, n, stride, reciprocal)) return false;
  const auto solve_rows = [&](int first, int last) {
    int i = first;
    for (; i + kPackWidth <= last; i += kPackWidth)
      solve_row<Pack, n>(
          A, stride, reciprocal, [&](int j) { return load(A + i + j * stride); },
          [&](int j, Pack x) { store(A + i + j * stride, x); });
    for (; i < last; ++i)
      solve_row<double, n>(
          A, stride, reciprocal, [&](int j) { return A[i + j * stride]; },
          [&](int j, double x) { A[i + j * stride] = x; });
  };
  parallel_for((rows - n + kNarrowRows - 1) / kNarrowRows, [&](int task) {
    const int first = n + task * kNarrowRows;
    solve_rows(first, std::min(rows, first + kNarrowRows));
  });
  return true;
}

void for_each(bool share, int count, FunctionRef<void(int)> body) {
  if (share) return parallel_for(count, body);
  for (int i = 0; i < count; ++i) body(i);
}

int block_count(int rows) { return (rows + kRowBlock - 1) / kRowBlock; }
size_t left_size(int rows, int depth) { return static_cast<size_t>(block_count(rows)) * kRowBlock * depth; }
size_t right_size(int rows, int depth) {
  const int columns = std::min(kColumnBlock, (rows + kTileColumns - 1) / kTileColumns * kTileColumns);
  return static_cast<size_t>(columns) * depth;
}

}  // namespace

size_t DenseCholesky::scratch(int rows, int columns) {
  const int depth = std::min(kDepthBlock, columns);
  return rows < kPackedFromRows ? 0 : left_size(rows, depth) + right_size(rows, depth);
}

void DenseCholesky::reserve(int rows, int columns) {
  if (rows < kPackedFromRows) return;
  const int depth = std::min(kDepthBlock, columns);
  packed_left_.resize(left_size(rows, depth));
  packed_right_.resize(right_size(rows, depth));
}

bool DenseCholesky::factorize(double* A, int rows, int columns, ptrdiff_t stride) {
  ASPIC_CHECK(columns % 3 == 0 && rows >= columns);
  switch (columns) {
    case 0:
      return true;
    case 3:
      return factorize_narrow<3>(A, rows, stride);
    case 6:
      return factorize_narrow<6>(A, rows, stride);
    case 9:
      return factorize_narrow<9>(A, rows, stride);
    case 12:
      return factorize_narrow<12>(A, rows, stride);
  }
  const int left = (columns / 2 + kBaseColumns - 1) / kBaseColumns * kBaseColumns, right = columns - left;
  double* C = A + left + left * stride;
  if (!factorize(A, rows, left, stride)) return false;
  put_outer_product(Product::subtract, {A + left, stride, rows - left, left}, {C, stride}, right);
  return factorize(C, rows - left, right, stride);
}

void DenseCholesky::put_outer_product(Product kind, ConstMatrix A, LowerMatrix C, int columns) {
  const int rows = A.rows, depth = A.columns;
  if (rows < kPackedFromRows) {
    const Operand left{A.data, kTileRows, A.stride, depth}, right{A.data, kTileColumns, A.stride, depth};
    return put_block(kind, left, right, C, {0, 0, rows, columns});
  }
  for (int j = 0; j < columns; j += kColumnBlock)
    for (int p = 0; p < depth; p += kDepthBlock) {
      const int width = std::min(kColumnBlock, columns - j), d = std::min(kDepthBlock, depth - p);
      const int blocks = block_count(rows - j);
      const auto pack_columns = [&](int task) {
        const int c = task * kPackedColumns;
        pack_strips<kTileColumns>(A.data + j + c + p * A.stride, A.stride, std::min(kPackedColumns, width - c), d,
                                  packed_right_.data() + static_cast<ptrdiff_t>(c) * d);
      };
      const Operand right{packed_right_.data(), static_cast<ptrdiff_t>(kTileColumns) * d, kTileColumns, d};
      const auto put_rows = [&](int task) {
        const int block = blocks - 1 - task;  // the longest first
        const int i = j + block * kRowBlock, height = std::min(kRowBlock, rows - i);
        double* packed = packed_left_.data() + static_cast<ptrdiff_t>(block) * kRowBlock * d;
        pack_strips<kTileRows>(A.data + i + p * A.stride, A.stride, height, d, packed);
        const Operand left{packed, static_cast<ptrdiff_t>(kTileRows) * d, kTileRows, d};
        put_block(p == 0 ? kind : Product::subtract, left, right, C, {i, j, height, width});
      };
      const bool share = static_cast<double>(rows - j) * width * d > kParallelFrom;
      for_each(share, (width + kPackedColumns - 1) / kPackedColumns, pack_columns);
      for_each(share, blocks, put_rows);
    }
}

}  // namespace aspic
