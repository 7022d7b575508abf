#include "linalg/cholesky.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <new>

#include "base/check.h"
#include "base/free_memory.h"
#include "base/parallel.h"
#include "linalg/conjugate_gradient.h"
#include "linalg/ordering.h"
#include "linalg/triangular_solve.h"
#include "math/pack.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// A substitution is bound by reading L twice. Flops of a factorization in the same time, per entry of L: measured on
// beams of 425 to 8 281 vertices.
constexpr double kFlopsPerEntry = 40;

constexpr int kStripBlocks = 24;  // block columns per task

// Returns an upper bound of |H|_2: the largest sum of the Frobenius norms of a block row.
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

// Calls visit(slot, i, transposed) for the blocks of H in column j of L; i >= j is the row in the elimination order.
template <class Visit>
void for_each_block(const BlockPattern& p, const Supernodes& s, int j, Visit visit) {
  const int r = s.order[j];
  for (int64_t b = p.row_start[r]; b <= p.diagonal(r); ++b)
    if (const int i = s.position[p.column[b]]; i >= j) visit(b, i, i > j);
  for (int64_t u = p.upper_start[r]; u < p.upper_start[r + 1]; ++u)
    if (const int i = s.position[p.upper_row[u]]; i >= j) visit(p.upper_slot[u], i, false);
}

std::string megabytes(int64_t bytes) { return std::to_string((bytes + 500'000) / 1'000'000) + " MB"; }

// The factorization as a preconditioner.
class FactorInverse : public ApproximateInverse {
 public:
  explicit FactorInverse(Cholesky& factor) : factor_(factor) {}
  std::string_view name() const override { return "cholesky"; }
  void analyze(const BlockPattern&) override {}
  bool factorize(const BlockSparse&) override { return true; }
  void apply(std::span<const double> r, std::span<double> z) override { factor_.substitute(r, z); }

 private:
  Cholesky& factor_;
};

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
  subtrees_ = make_subtrees(supernodes_);
  const int64_t rows = pattern.rows();
  int64_t doubles = subtrees_.panels + subtrees_.workspace + kReadAhead + 6 * rows + pattern.block_count();
  for (const Subtrees::Task& task : subtrees_.tasks)
    doubles += static_cast<int64_t>(DenseCholesky::scratch(task.rows, task.columns));
  doubles += static_cast<int64_t>(DenseCholesky::scratch(subtrees_.top_rows, subtrees_.top_columns));
  supernodes_.cost.bytes = 8 * doubles + 3 * 4 * supernodes_.row_start.back();
}

bool Cholesky::allocate() {
  free_bytes_ = std::min(memory_limit_, free_memory());
  if (supernodes_.cost.bytes > free_bytes_) return false;
  try {
    list_rows(*pattern_, supernodes_);
    find_targets();
    L_.assign(subtrees_.panels, 0.0);
    workspace_.assign(subtrees_.workspace + kReadAhead, 0.0);
    for (std::vector<double>* v : {&permuted_, &residual_}) v->assign(3 * static_cast<size_t>(pattern_->rows()), 0.0);
    kernels_.resize(subtrees_.tasks.size() + 1);
    for (size_t t = 0; t < subtrees_.tasks.size(); ++t)
      kernels_[t].reserve(subtrees_.tasks[t].rows, subtrees_.tasks[t].columns);
    kernels_.back().reserve(subtrees_.top_rows, subtrees_.top_columns);
  } catch (const std::bad_alloc&) {
    return false;
  }
  return true;
}

struct Cholesky::Front {
  int width, below;  // block columns of the panel and of the update matrix
  int64_t rows;      // rows of the panel
  double *panel, *update;

  LowerMatrix update_matrix() const { return {update, 3 * static_cast<std::ptrdiff_t>(below), true}; }
  double* column(int j, int c) const {  // column c of block column j; entry (i, 3 j + c) of the front is at [i]
    return j < width ? panel + (3 * j + c) * rows : update_matrix().column(3 * (j - width) + c) - 3 * width;
  }
};

Cholesky::Front Cholesky::front(int s) {
  const int width = supernodes_.width(s), below = supernodes_.below(s);
  return {width, below, 3 * (static_cast<int64_t>(width) + below), L_.data() + subtrees_.panel_start[s],
          workspace_.data() + subtrees_.update_start[s]};
}

void Cholesky::find_targets() {
  target_.resize(pattern_->block_count());
  std::vector<int> local(pattern_->rows());  // row of the current front
  for (int s = 0; s < supernodes_.count(); ++s) {
    const int width = supernodes_.width(s), below = supernodes_.below(s), begin = supernodes_.first[s];
    const int* row = supernodes_.row.data() + supernodes_.row_start[s];
    for (int i = 0; i < width; ++i) local[begin + i] = i;
    for (int i = 0; i < below; ++i) local[row[i]] = width + i;
    for (int i = 0; i < width; ++i)
      for_each_block(*pattern_, supernodes_, begin + i, [&](int64_t slot, int k, bool) {
        target_[slot] = subtrees_.panel_start[s] + 9 * static_cast<int64_t>(width + below) * i + 3 * local[k];
      });
  }
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
  std::atomic<bool> definite = true;
  parallel_for(static_cast<int>(subtrees_.tasks.size()), [&](int t) {
    const Subtrees::Task& task = subtrees_.tasks[t];
    for (int s = task.first; s < task.last && definite; ++s)
      if (!factorize_supernode(H, s, kernels_[t])) definite = false;
  });
  for (size_t i = 0; i < subtrees_.top.size() && definite; ++i)
    definite = factorize_supernode(H, subtrees_.top[i], kernels_.back());
  if (definite) H_ = &H;
  if (definite && !H.stencils.empty()) {
    with_stencils_ = std::make_unique<ConjugateGradient>(std::make_unique<FactorInverse>(*this));
    with_stencils_->analyze(*pattern_);
    with_stencils_->factorize(H);
  }
  return definite;
}

bool Cholesky::factorize_supernode(const BlockSparse& H, int s, DenseCholesky& kernels) {
  const Front f = front(s);
  const int columns = 3 * f.width, below = 3 * f.below;
  const auto for_each_strip = [](int begin, int end, FunctionRef<void(int, int)> body) {
    parallel_for((end - begin + kStripBlocks - 1) / kStripBlocks, [&](int strip) {
      const int first = begin + strip * kStripBlocks;
      body(first, std::min(end, first + kStripBlocks));
    });
  };
  for_each_strip(0, f.width, [&](int first, int last) {
    clear_panel(f, first, last);
    assemble(H, s, first, last);
    add_children(s, f, first, last);
  });
  if (!kernels.factorize(f.panel, static_cast<int>(f.rows), columns, f.rows)) return false;
  if (!pivots_are_sound(H, s, f.panel)) return false;
  if (below == 0) return true;
  const ConstMatrix L21{f.panel + columns, static_cast<std::ptrdiff_t>(f.rows), below, columns};
  kernels.put_outer_product(DenseCholesky::Product::set, L21, f.update_matrix(), below);
  for_each_strip(f.width, f.width + f.below, [&](int first, int last) { add_children(s, f, first, last); });
  return true;
}

// Clears the lower triangle and the whole diagonal blocks.
void Cholesky::clear_panel(const Front& f, int first, int last) {
  for (int j = first; j < last; ++j)
    for (int c = 0; c < 3; ++c) std::fill_n(f.column(j, c) + 3 * j, f.rows - 3 * j, 0.0);
}

void Cholesky::assemble(const BlockSparse& H, int s, int first, int last) {
  const int64_t rows = front(s).rows;
  for (int j = supernodes_.first[s] + first; j < supernodes_.first[s] + last; ++j) {
    for_each_block(*pattern_, supernodes_, j, [&](int64_t slot, int, bool transposed) {
      const Mat3d A = transposed ? transpose(H.block[slot]) : H.block[slot];
      for (int c = 0; c < 3; ++c) std::copy_n(A.a + 3 * c, 3, L_.data() + target_[slot] + c * rows);
    });
  }
}

// Adds the children's update matrices to the block columns [first, last) of their parent's front (extend-add).
void Cholesky::add_children(int s, const Front& f, int first, int last) {
  for (int child = last_child_[s]; child >= 0; child = sibling_[child]) {
    const Front from = front(child);
    const int* row = supernodes_.in_parent.data() + supernodes_.row_start[child];
    const int* run_end = supernodes_.run_end.data() + supernodes_.row_start[child];
    const int begin = static_cast<int>(std::lower_bound(row, row + from.below, first) - row);
    for (int b = begin; b < from.below && row[b] < last; ++b)
      for (int c = 0; c < 3; ++c) {
        const double* in = from.column(from.width + b, c) + 3 * from.width;
        double* out = f.column(row[b], c);
        for (int a = b, k = c; a < from.below; a = run_end[a], k = 0) {  // k: skips entries above the diagonal
          double* run = out + 3 * row[a];
          for (const int count = 3 * (run_end[a] - a); k < count; ++k) run[k] += in[3 * a + k];
        }
      }
  }
}

// Rejects pivots at the round-off level of their diagonal entries, whose signs are not significant.
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
  if (!H_->stencils.empty()) return with_stencils_->solve(b, x, tolerance);
  SolveReport report;
  substitute(b, x);
  const double b_norm = norm(b);
  double r_norm = 0;
  for (int refinements = 0;; ++refinements) {
    r_norm = residual(b, x);
    ++report.products;
    if (!(r_norm > tolerance * b_norm) || refinements == 1) break;
    add_substituted(residual_, x);
  }
  report.relative_residual = b_norm > 0 ? r_norm / b_norm : 0;
  report.ok = r_norm <= tolerance * b_norm;
  if (report.ok) return report;
  // If the tolerance is below round-off, accepts a residual at the round-off level of H x.
  const double H_norm = norm_bound(*H_, {permuted_.data(), static_cast<size_t>(pattern_->rows())});
  report.ok = r_norm <= 64 * kEpsilon * (H_norm * norm(x) + b_norm);
  return report;
}

double Cholesky::residual(std::span<const double> b, std::span<const double> x) {
  H_->multiply(x, residual_);
  for (size_t i = 0; i < residual_.size(); ++i) residual_[i] = b[i] - residual_[i];
  return norm(residual_);
}

bool Cholesky::substitute(std::span<const double> b, std::span<double> x) {
  if (!H_) return false;
  std::fill(x.begin(), x.end(), 0.0);
  add_substituted(b, x);
  return true;
}

double Cholesky::substitutions_per_factorization() const {
  return H_ ? analysis().flops / (kFlopsPerEntry * static_cast<double>(analysis().nnz)) : 0;
}

void Cholesky::add_substituted(std::span<const double> b, std::span<double> x) {
  const Supernodes& s = supernodes_;
  const int n = static_cast<int>(s.order.size()), tasks = static_cast<int>(subtrees_.tasks.size());
  for (int k = 0; k < n; ++k)
    std::copy_n(&b[3 * static_cast<size_t>(s.order[k])], 3, &permuted_[3 * static_cast<size_t>(k)]);
  parallel_for(tasks, [&](int t) {
    for (int k = subtrees_.tasks[t].first; k < subtrees_.tasks[t].last; ++k) substitute_forward(k);
  });
  for (const int k : subtrees_.top) substitute_forward(k);
  for (size_t i = subtrees_.top.size(); i-- > 0;) substitute_backward(subtrees_.top[i]);
  parallel_for(tasks, [&](int t) {
    for (int k = subtrees_.tasks[t].last - 1; k >= subtrees_.tasks[t].first; --k) substitute_backward(k);
  });
  for (int k = 0; k < n; ++k)
    for (int d = 0; d < 3; ++d) x[3 * static_cast<size_t>(s.order[k]) + d] += permuted_[3 * static_cast<size_t>(k) + d];
}

// The contributions of s to the rows below use the memory of the update matrix, and so do those of its children.
void Cholesky::substitute_forward(int s) {
  const Front f = front(s);
  double *own = permuted_.data() + 3 * static_cast<size_t>(supernodes_.first[s]), *rest = f.update;
  std::fill_n(rest, 3 * f.below, 0.0);
  for (int c = last_child_[s]; c >= 0; c = sibling_[c]) {
    const Front child = front(c);
    const int* row = supernodes_.in_parent.data() + supernodes_.row_start[c];
    for (int i = 0; i < child.below; ++i) {
      double* out = row[i] < f.width ? own + 3 * row[i] : rest + 3 * (row[i] - f.width);
      for (int d = 0; d < 3; ++d) out[d] += child.update[3 * i + d];
    }
  }
  solve_forward(f.panel, static_cast<int>(f.rows), 3 * f.width, own, rest);
}

void Cholesky::substitute_backward(int s) {
  const Front f = front(s);
  const int* row = supernodes_.row.data() + supernodes_.row_start[s];
  for (int i = 0; i < f.below; ++i) std::copy_n(&permuted_[3 * static_cast<size_t>(row[i])], 3, f.update + 3 * i);
  solve_backward(f.panel, static_cast<int>(f.rows), 3 * f.width,
                 permuted_.data() + 3 * static_cast<size_t>(supernodes_.first[s]), f.update);
}

std::string Cholesky::description() const {
  if (!pattern_) return "cholesky";
  const std::string need = "cholesky: the factor has " + std::to_string(supernodes_.cost.nnz) + " entries and needs " +
                           megabytes(supernodes_.cost.bytes);
  return refused_ ? need + ", but only " + megabytes(free_bytes_) + " are free" : need;
}

}  // namespace aspic
