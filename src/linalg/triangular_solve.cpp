#include "linalg/triangular_solve.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "base/parallel.h"
#include "linalg/lower_matrix.h"
#include "math/pack.h"

namespace aspic {
namespace {

using std::ptrdiff_t;

constexpr int kTriangle = 48;             // columns that are solved before the rest is updated
constexpr int kRowChunk = 256;            // rows of y that fit into the L1 cache
constexpr int kColumnChunk = 12;          // dot products per task
constexpr ptrdiff_t kShareFrom = 32'000;  // entries of L; about 10 us on one core

Pack load(const double* p) {
  Pack x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
void store(double* p, Pack x) { std::memcpy(p, &x, sizeof x); }

// y -= A x for n columns.
template <int n>
void subtract_columns(const double* A, ptrdiff_t stride, int rows, const double* x, double* y) {
  Pack factor[n];
  for (int c = 0; c < n; ++c) factor[c] = Pack(x[c]);
  int i = 0;
  for (; i + kPackWidth <= rows; i += kPackWidth) {
    Pack sum = load(y + i);
    for (int c = 0; c < n; ++c) sum -= load(A + c * stride + i) * factor[c];
    store(y + i, sum);
  }
  for (; i < rows; ++i)
    for (int c = 0; c < n; ++c) y[i] -= A[c * stride + i] * x[c];
}

void subtract_rows(ConstMatrix A, const double* x, double* y) {
  int c = 0;
  for (; c + 6 <= A.columns; c += 6) subtract_columns<6>(A.data + c * A.stride, A.stride, A.rows, x + c, y);
  if (c < A.columns) subtract_columns<3>(A.data + c * A.stride, A.stride, A.rows, x + c, y);
}

bool is_shared(ConstMatrix A) { return static_cast<ptrdiff_t>(A.rows) * A.columns >= kShareFrom; }

// y -= A x
void subtract_product(ConstMatrix A, const double* x, double* y) {
  if (A.rows <= 0) return;
  if (!is_shared(A)) return subtract_rows(A, x, y);
  parallel_for((A.rows + kRowChunk - 1) / kRowChunk, [&](int chunk) {
    const int first = chunk * kRowChunk;
    subtract_rows({A.data + first, A.stride, std::min(kRowChunk, A.rows - first), A.columns}, x, y + first);
  });
}

// x -= A' y for n columns.
template <int n>
void subtract_dots(const double* A, ptrdiff_t stride, int rows, const double* y, double* x) {
  Pack sums[n];
  for (int c = 0; c < n; ++c) sums[c] = Pack(0.0);
  int i = 0;
  for (; i + kPackWidth <= rows; i += kPackWidth) {
    const Pack v = load(y + i);
    for (int c = 0; c < n; ++c) sums[c] += load(A + c * stride + i) * v;
  }
  for (int c = 0; c < n; ++c) {
    double total = sum(sums[c]);
    for (int r = i; r < rows; ++r) total += A[c * stride + r] * y[r];
    x[c] -= total;
  }
}

void subtract_column_dots(ConstMatrix A, const double* y, double* x) {
  int c = 0;
  for (; c + 6 <= A.columns; c += 6) subtract_dots<6>(A.data + c * A.stride, A.stride, A.rows, y, x + c);
  if (c < A.columns) subtract_dots<3>(A.data + c * A.stride, A.stride, A.rows, y, x + c);
}

// x -= A' y
void subtract_transposed_product(ConstMatrix A, const double* y, double* x) {
  if (A.rows <= 0) return;
  if (!is_shared(A)) return subtract_column_dots(A, y, x);
  parallel_for((A.columns + kColumnChunk - 1) / kColumnChunk, [&](int chunk) {
    const int first = chunk * kColumnChunk;
    subtract_column_dots(A.columns_from(first, std::min(kColumnChunk, A.columns - first)), y, x + first);
  });
}

// Processes three columns at once, so that x is read and written once for them.
void solve_triangle(const double* L, ptrdiff_t stride, int n, double* x) {
  for (int j = 0; j < n; j += 3) {
    const double *a = L + j * stride, *b = a + stride, *c = b + stride;
    x[j] /= a[j];
    x[j + 1] = (x[j + 1] - a[j + 1] * x[j]) / b[j + 1];
    x[j + 2] = (x[j + 2] - a[j + 2] * x[j] - b[j + 2] * x[j + 1]) / c[j + 2];
    subtract_columns<3>(a + j + 3, stride, n - j - 3, x + j, x + j + 3);
  }
}

void solve_transposed_triangle(const double* L, ptrdiff_t stride, int n, double* x) {
  for (int j = n - 3; j >= 0; j -= 3) {
    const double *a = L + j * stride, *b = a + stride, *c = b + stride;
    subtract_dots<3>(a + j + 3, stride, n - j - 3, x + j + 3, x + j);
    x[j + 2] /= c[j + 2];
    x[j + 1] = (x[j + 1] - b[j + 2] * x[j + 2]) / b[j + 1];
    x[j] = (x[j] - a[j + 1] * x[j + 1] - a[j + 2] * x[j + 2]) / a[j];
  }
}

}  // namespace

void solve_forward(const double* L, int rows, int columns, double* x, double* y) {
  const ptrdiff_t stride = rows;
  for (int j = 0; j < columns; j += kTriangle) {
    const int n = std::min(kTriangle, columns - j);
    const double* triangle = L + j * (stride + 1);
    solve_triangle(triangle, stride, n, x + j);
    subtract_product({triangle + n, stride, columns - j - n, n}, x + j, x + j + n);
  }
  subtract_product({L + columns, stride, rows - columns, columns}, x, y);
}

void solve_backward(const double* L, int rows, int columns, double* x, const double* y) {
  const ptrdiff_t stride = rows;
  subtract_transposed_product({L + columns, stride, rows - columns, columns}, y, x);
  for (int j = (columns - 1) / kTriangle * kTriangle; j >= 0; j -= kTriangle) {
    const int n = std::min(kTriangle, columns - j);
    const double* triangle = L + j * (stride + 1);
    subtract_transposed_product({triangle + n, stride, columns - j - n, n}, x + j + n, x + j);
    solve_transposed_triangle(triangle, stride, n, x + j);
  }
}

}  // namespace aspic
