#include "linalg/cholesky.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

#include "base/check.h"
#include "linalg/free_memory.h"
#include "linalg/ordering.h"

namespace aspic {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

int64_t update_size(const Supernodes& s, int k) { return 9 * static_cast<int64_t>(s.below(k)) * s.below(k); }

// Largest number of doubles on the stack: the new update matrix lies above its children's until they are added.
int64_t stack_peak(const Supernodes& s, const std::vector<int>& last_child, const std::vector<int>& sibling) {
  int64_t top = 0, peak = 0;
  for (int k = 0; k < s.count(); ++k) {
    peak = std::max(peak, top + update_size(s, k));
    for (int c = last_child[k]; c >= 0; c = sibling[c]) top -= update_size(s, c);
    top += update_size(s, k);
  }
  return peak;
}

int largest_front(const Supernodes& s) {
  int rows = 0;
  for (int k = 0; k < s.count(); ++k) rows = std::max(rows, 3 * (s.width(k) + s.below(k)));
  return rows;
}

// Clears the lower triangle (whole diagonal blocks) of the first `columns` columns.
void clear_lower(double* A, int64_t rows, int64_t columns) {
  for (int64_t c = 0; c < columns; ++c) {
    const int64_t from = c / 3 * 3;
    std::memset(A + c * rows + from, 0, (rows - from) * sizeof(double));
  }
}

double norm(std::span<const double> v) {
  double sum = 0;
  for (const double value : v) sum += value * value;
  return std::sqrt(sum);
}

// An upper bound of |H|_2: the largest sum of the Frobenius norms of a row of blocks.
double norm_bound(const BlockSparse& H, std::span<double> row_sum) {
  const BlockPattern& p = *H.pattern;
  std::fill(row_sum.begin(), row_sum.end(), 0.0);
  double largest = 0;
  for (int r = 0; r < p.rows(); ++r)
    for (int64_t s = p.row_start[r]; s < p.row_start[r + 1]; ++s) {
      const double size = std::sqrt(squared_norm(H.block[s]));
      row_sum[r] += size;
      if (p.column[s] != r) row_sum[p.column[s]] += size;
    }
  for (int r = 0; r < p.rows(); ++r) largest = std::max(largest, row_sum[r]);
  return largest;
}

std::string megabytes(int64_t bytes) { return std::to_string((bytes + 500'000) / 1'000'000) + " MB"; }

}  // namespace

void Cholesky::analyze(const BlockPattern& pattern) {
  pattern_ = &pattern;
  H_ = nullptr;
  allocated_ = refused_ = false;
  supernodes_ = find_supernodes(pattern, fill_reducing_order(pattern));
  const int count = supernodes_.count();
  last_child_.assign(count, -1);
  sibling_.assign(count, -1);
  for (int k = 0; k < count; ++k)
    if (const int p = supernodes_.parent[k]; p >= 0) sibling_[k] = last_child_[p], last_child_[p] = k;
  const int64_t doubles = supernodes_.cost.nnz + stack_peak(supernodes_, last_child_, sibling_) + 2 * kReadAhead +
                          9 * static_cast<int64_t>(pattern.rows()) + largest_front(supernodes_) +
                          static_cast<int64_t>(DenseCholesky::scratch(largest_front(supernodes_)));
  supernodes_.cost.bytes = 8 * doubles + 4 * (supernodes_.row_start.back() + pattern.rows());
}

bool Cholesky::allocate() {
  free_bytes_ = std::min(memory_limit_, free_memory());
  if (supernodes_.cost.bytes > free_bytes_) return false;
  try {
    list_rows(*pattern_, supernodes_);
    L_.assign(supernodes_.cost.nnz + kReadAhead, 0.0);
    stack_.assign(stack_peak(supernodes_, last_child_, sibling_) + kReadAhead, 0.0);
    local_.assign(pattern_->rows(), -1);
    for (std::vector<double>* v : {&permuted_, &residual_}) v->assign(3 * static_cast<size_t>(pattern_->rows()), 0.0);
    kernels_.reserve(largest_front(supernodes_));
    front_.assign(largest_front(supernodes_), 0.0);
  } catch (const std::bad_alloc&) {
    return false;
  }
  return true;
}

bool Cholesky::factorize(const BlockSparse& H) {
  ASPIC_CHECK(pattern_ && H.pattern->version == pattern_->version);
  pattern_ = H.pattern;
  H_ = nullptr;
  if (!allocated_) {
    allocated_ = allocate();
    refused_ = !allocated_;
    if (refused_) return false;
  }
  H_norm_ = norm_bound(H, {residual_.data(), static_cast<size_t>(pattern_->rows())});
  stack_top_ = 0;
  for (int s = 0; s < supernodes_.count(); ++s)
    if (!factorize_supernode(H, s)) return false;
  H_ = &H;
  return true;
}

bool Cholesky::factorize_supernode(const BlockSparse& H, int s) {
  const int width = supernodes_.width(s), below = supernodes_.below(s);
  const int64_t columns = 3 * width, rows = columns + 3 * below, update_rows = 3 * below;
  double* panel = L_.data() + supernodes_.value_start[s];
  double* update = stack_.data() + stack_top_;
  for (int i = 0; i < width; ++i) local_[supernodes_.first[s] + i] = i;
  for (int i = 0; i < below; ++i) local_[supernodes_.row[supernodes_.row_start[s] + i]] = width + i;
  clear_lower(panel, rows, columns);
  clear_lower(update, update_rows, update_rows);
  assemble(H, s, panel);
  int64_t children_begin = stack_top_;
  for (int c = last_child_[s]; c >= 0; c = sibling_[c]) {  // they lie on the stack in this order, from the top
    children_begin -= update_size(supernodes_, c);
    add_update(c, s, panel, update);
    stack_top_ = children_begin;
  }
  if (!kernels_.factorize(panel, static_cast<int>(rows), static_cast<int>(columns), rows)) return false;
  if (!pivots_are_sound(H, s, panel)) return false;
  if (below == 0) return true;
  kernels_.subtract_outer_product(panel + columns, rows, static_cast<int>(columns), update, update_rows,
                                  static_cast<int>(update_rows), static_cast<int>(update_rows));
  std::memmove(stack_.data() + stack_top_, update, update_rows * update_rows * sizeof(double));
  stack_top_ += update_rows * update_rows;
  return true;
}

void Cholesky::assemble(const BlockSparse& H, int s, double* panel) {
  const BlockPattern& p = *pattern_;
  const int64_t rows = 3 * (supernodes_.width(s) + supernodes_.below(s));
  for (int j = supernodes_.first[s]; j < supernodes_.first[s + 1]; ++j) {
    const int r = supernodes_.order[j];
    double* const column = panel + 3 * rows * (j - supernodes_.first[s]);
    const auto put = [&](int row, const Mat3d& A) {  // rows before the diagonal belong to other columns
      if (const int i = supernodes_.position[row]; i >= j)
        for (int c = 0; c < 3; ++c) std::copy_n(A.a + 3 * c, 3, column + c * rows + 3 * local_[i]);
    };
    for (int64_t b = p.row_start[r]; b < p.diagonal(r); ++b) put(p.column[b], transpose(H.block[b]));
    put(r, H.block[p.diagonal(r)]);
    for (int64_t u = p.upper_start[r]; u < p.upper_start[r + 1]; ++u) put(p.upper_row[u], H.block[p.upper_slot[u]]);
  }
}

// Adds the child's update matrix, which ends where the stack ends, to the front of s (extend-add).
void Cholesky::add_update(int child, int s, double* panel, double* update) {
  const int width = supernodes_.width(s), blocks = supernodes_.below(child);
  const int64_t rows = 3 * (width + supernodes_.below(s)), update_rows = 3 * supernodes_.below(s);
  const int64_t child_rows = 3 * static_cast<int64_t>(blocks);
  const double* from = stack_.data() + stack_top_ - child_rows * child_rows;
  const int* row = supernodes_.row.data() + supernodes_.row_start[child];
  for (int b = 0; b < blocks; ++b) {
    const int j = local_[row[b]];
    for (int c = 0; c < 3; ++c) {
      const double* in = from + (3 * b + c) * child_rows;
      double* out = j < width ? panel + (3 * j + c) * rows : update + (3 * (j - width) + c) * update_rows - 3 * width;
      for (int a = b; a < blocks; ++a) {
        double* block = out + 3 * local_[row[a]];
        for (int k = 0; k < 3; ++k) block[k] += in[3 * a + k];
      }
    }
  }
}

// A pivot that is round-off of the diagonal it came from says nothing about H being positive definite.
bool Cholesky::pivots_are_sound(const BlockSparse& H, int s, const double* panel) const {
  const int64_t rows = 3 * (supernodes_.width(s) + supernodes_.below(s));
  for (int i = 0; i < supernodes_.width(s); ++i) {
    const Mat3d& D = H.block[pattern_->diagonal(supernodes_.order[supernodes_.first[s] + i])];
    for (int k = 0; k < 3; ++k) {
      const double pivot = panel[(3 * i + k) * (rows + 1)];
      if (!(pivot * pivot > 4 * kEpsilon * D(k, k))) return false;
    }
  }
  return true;
}

SolveReport Cholesky::solve(std::span<const double> b, std::span<double> x, double tolerance) {
  ASPIC_CHECK(H_ && b.size() == permuted_.size() && x.size() == b.size());
  SolveReport report;
  std::fill(x.begin(), x.end(), 0.0);
  substitute(b, x);
  const double b_norm = norm(b);
  double r_norm = 0;
  for (int refinements = 0;; ++refinements) {
    H_->multiply(x, residual_);
    for (size_t i = 0; i < residual_.size(); ++i) residual_[i] = b[i] - residual_[i];
    r_norm = norm(residual_);
    if (!(r_norm > tolerance * b_norm) || refinements == 1) break;
    substitute(residual_, x);
  }
  report.relative_residual = b_norm > 0 ? r_norm / b_norm : 0;
  // Where the tolerance is below round-off, a residual as small as the rounding of H x is all that can be had.
  const double round_off = 64 * kEpsilon * (H_norm_ * norm(x) + b_norm);
  report.ok = r_norm <= tolerance * b_norm || r_norm <= round_off;
  return report;
}

void Cholesky::substitute(std::span<const double> b, std::span<double> x) {
  const Supernodes& s = supernodes_;
  const size_t n = s.order.size();
  for (size_t k = 0; k < n; ++k) std::copy_n(&b[3 * static_cast<size_t>(s.order[k])], 3, &permuted_[3 * k]);
  for (int k = 0; k < s.count(); ++k) {
    const int columns = 3 * s.width(k), below = s.below(k);
    double* own = permuted_.data() + 3 * static_cast<size_t>(s.first[k]);
    double* rest = front_.data() + columns;
    const int* row = s.row.data() + s.row_start[k];
    std::copy_n(own, columns, front_.data());
    std::fill_n(rest, 3 * below, 0.0);
    solve_forward(L_.data() + s.value_start[k], columns + 3 * below, columns, front_.data());
    std::copy_n(front_.data(), columns, own);
    for (int i = 0; i < below; ++i)
      for (int d = 0; d < 3; ++d) permuted_[3 * static_cast<size_t>(row[i]) + d] += rest[3 * i + d];
  }
  for (int k = s.count() - 1; k >= 0; --k) {
    const int columns = 3 * s.width(k), below = s.below(k);
    double* own = permuted_.data() + 3 * static_cast<size_t>(s.first[k]);
    double* rest = front_.data() + columns;
    const int* row = s.row.data() + s.row_start[k];
    std::copy_n(own, columns, front_.data());
    for (int i = 0; i < below; ++i) std::copy_n(&permuted_[3 * static_cast<size_t>(row[i])], 3, rest + 3 * i);
    solve_backward(L_.data() + s.value_start[k], columns + 3 * below, columns, front_.data());
    std::copy_n(front_.data(), columns, own);
  }
  for (size_t k = 0; k < n; ++k)
    for (int d = 0; d < 3; ++d) x[3 * static_cast<size_t>(s.order[k]) + d] += permuted_[3 * k + d];
}

std::string Cholesky::description() const {
  if (!pattern_) return "cholesky";
  const std::string need = "cholesky: the factor has " + std::to_string(supernodes_.cost.nnz) + " entries and needs " +
                           megabytes(supernodes_.cost.bytes);
  return refused_ ? need + ", but " + megabytes(free_bytes_) + " are free: refused" : need;
}

}  // namespace aspic
