#include "linalg/gauss_seidel.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <numeric>

#include "base/check.h"
#include "base/parallel.h"

namespace aspic {
namespace {

constexpr int kRowsPerTask = 192;
constexpr int kRowsWorthSharing = 1024;  // of a colour or a whole loop; below, waking threads costs more than it saves

}  // namespace

void GaussSeidel::analyze(const BlockPattern& p, int rows_per_vertex, std::span<const int> group,
                          std::span<const int> color_of_group) {
  const int rows = p.rows(), groups = static_cast<int>(color_of_group.size());
  ASPIC_CHECK(static_cast<int>(group.size()) == rows && p.block_count() <= INT32_MAX);
  ASPIC_CHECK(rows_per_vertex == 1 || rows_per_vertex == 4);
  const int colors = groups == 0 ? 0 : 1 + *std::max_element(color_of_group.begin(), color_of_group.end());

  std::vector<int> size(groups, 0);
  for (const int g : group)
    if (g >= 0) ++size[g];
  std::vector<int> groups_in_order(groups);
  std::iota(groups_in_order.begin(), groups_in_order.end(), 0);
  std::stable_sort(groups_in_order.begin(), groups_in_order.end(),
                   [&](int a, int b) { return color_of_group[a] < color_of_group[b]; });
  range_.assign(groups, {});
  tasks_.assign(colors + 1, {});
  int next = 0;
  for (const int g : groups_in_order) {
    range_[g] = {next, next + size[g]};
    std::vector<Range>& tasks = tasks_[color_of_group[g]];
    if (tasks.empty() || tasks.back().last - tasks.back().first >= kRowsPerTask) tasks.push_back({next, next});
    next += size[g];
    tasks.back().last = next;
  }
  if (next < rows) tasks_[colors].push_back({next, rows});

  std::vector<int> place(groups), position(rows);
  for (int g = 0; g < groups; ++g) place[g] = range_[g].first;
  order_.resize(rows);
  for (int row = 0; row < rows; ++row) {
    position[row] = group[row] >= 0 ? place[group[row]]++ : next++;
    order_[position[row]] = row;
  }

  rows_per_vertex_ = rows_per_vertex;
  for (auto* v : {&own_, &inverse_}) v->assign(9 * static_cast<size_t>(rows) * rows_per_vertex + kSpareLanes, 0.0F);
  struct Entry {
    int column, source;
  };
  std::vector<Entry> entries;
  for (Triangle* t : {&lower_, &upper_}) {
    t->start.assign(1, 0);
    t->column.clear(), t->source.clear();
    t->column.reserve(p.block_count() - rows), t->source.reserve(p.block_count() - rows);
  }
  for (int k = 0; k < rows; ++k) {
    const int row = order_[k];
    entries.clear();
    for (int64_t s = p.row_start[row]; s < p.diagonal(row); ++s)
      entries.push_back({position[p.column[s]], static_cast<int>(s)});
    for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u)
      entries.push_back({position[p.upper_row[u]], ~static_cast<int>(p.upper_slot[u])});
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
    for (const Entry& entry : entries) {
      if (entry.column / rows_per_vertex == k / rows_per_vertex) continue;
      Triangle& t = entry.column < k ? lower_ : upper_;
      t.column.push_back(entry.column);
      t.source.push_back(entry.source);
    }
    for (Triangle* t : {&lower_, &upper_}) t->start.push_back(static_cast<int64_t>(t->column.size()));
  }
  for (Triangle* t : {&lower_, &upper_}) t->value.assign(9 * t->column.size() + kSpareLanes, 0.0F);
}

template <int B>
bool GaussSeidel::load_diagonal(const BlockSparse& H, int vertex) {
  constexpr int N = 3 * B;
  using Dense = Eigen::Matrix<double, N, N>;
  const BlockPattern& p = *H.pattern;
  Dense A = Dense::Zero();
  for (int m = 0; m < B; ++m) {
    const int64_t diagonal = p.diagonal(order_[B * vertex + m]);
    for (int n = 0; n <= m; ++n)
      for (int i = 0; i < 9; ++i) A(3 * m + i % 3, 3 * n + i / 3) = H.block[diagonal - m + n].a[i];
  }
  A = A.template selfadjointView<Eigen::Lower>();
  const Eigen::LLT<Dense> factor(A);
  if (factor.info() != Eigen::Success) return false;
  const Dense inverse = factor.solve(Dense::Identity());
  for (int m = 0; m < B; ++m)
    for (int n = 0; n < B; ++n)
      for (int i = 0; i < 9; ++i) {
        const size_t to = 9 * (B * static_cast<size_t>(B * vertex + m) + n) + i;
        own_[to] = static_cast<float>(A(3 * m + i % 3, 3 * n + i / 3));
        inverse_[to] = static_cast<float>(inverse(3 * m + i % 3, 3 * n + i / 3));
      }
  return true;
}

bool GaussSeidel::load(const BlockSparse& H) {
  std::atomic<bool> definite = true;
  parallel_chunks(rows(), [&](int first, int last) {
    for (int k = first; k < last; k += rows_per_vertex_)
      if (!(rows_per_vertex_ == 1 ? load_diagonal<1>(H, k) : load_diagonal<4>(H, k / 4))) definite = false;
    for (Triangle* t : {&lower_, &upper_})
      for (int64_t s = t->start[first]; s < t->start[last]; ++s) {
        const int source = t->source[s];
        float* to = &t->value[9 * s];
        if (source >= 0) {
          const double* from = H.block[source].a;
          for (int i = 0; i < 9; ++i) to[i] = static_cast<float>(from[i]);
        } else {
          const double* from = H.block[~source].a;
          for (int i = 0; i < 9; ++i) to[i] = static_cast<float>(from[3 * (i % 3) + i / 3]);
        }
      }
  });
  return definite;
}

QuadF GaussSeidel::row_product(const Triangle& t, int row, const float* x) {
  const auto at = [&](int64_t s) { return x + kFloatsPerRow * static_cast<size_t>(t.column[s]); };
  QuadF even = QuadF::zero(), odd = QuadF::zero();
  int64_t s = t.start[row];
  const int64_t end = t.start[row + 1];
  for (; s + 1 < end; s += 2) {
    even += product(&t.value[9 * s], at(s));
    odd += product(&t.value[9 * (s + 1)], at(s + 1));
  }
  if (s < end) even += product(&t.value[9 * s], at(s));
  return even + odd;
}

template <class Body>
void GaussSeidel::for_each_task(bool ascending, const Body& body) const {
  const int colors = static_cast<int>(tasks_.size());
  for (int c = 0; c < colors; ++c) {
    const std::vector<Range>& tasks = tasks_[ascending ? c : colors - 1 - c];
    if (tasks.empty()) continue;
    if (tasks.back().last - tasks.front().first >= kRowsWorthSharing)
      parallel_for(static_cast<int>(tasks.size()), [&](int t) { body(tasks[t]); });
    else
      for (const Range& range : tasks) body(range);
  }
}

// The rows of one vertex, with what their neighbours are now.
template <int B>
void GaussSeidel::relax(int vertex, const float* b, float* x, bool upper_too) const {
  const int first = B * vertex;
  float s[4 * B];
  for (int m = 0; m < B; ++m) {
    const int k = first + m;
    QuadF sum = QuadF::load(b + kFloatsPerRow * static_cast<size_t>(k)) - row_product(lower_, k, x);
    if (upper_too) sum -= row_product(upper_, k, x);
    sum.store(s + 4 * m);
  }
  const float* inverse = &inverse_[9 * B * static_cast<size_t>(first)];
  for (int m = 0; m < B; ++m) {
    QuadF sum = product(inverse + 9 * B * m, s);
    for (int n = 1; n < B; ++n) sum += product(inverse + 9 * (B * m + n), s + 4 * n);
    sum.store(x + kFloatsPerRow * static_cast<size_t>(first + m));
  }
}

void GaussSeidel::sweep_forward(const float* b, float* x) const {
  for_each_task(true, [&](const Range& range) {
    if (rows_per_vertex_ == 1)
      for (int k = range.first; k < range.last; ++k) relax<1>(k, b, x, false);
    else
      for (int v = range.first / 4; v < range.last / 4; ++v) relax<4>(v, b, x, false);
  });
}

void GaussSeidel::sweep_backward(const float* b, float* x) const {
  for_each_task(false, [&](const Range& range) {
    if (rows_per_vertex_ == 1)
      for (int k = range.last - 1; k >= range.first; --k) relax<1>(k, b, x, true);
    else
      for (int v = range.last / 4 - 1; v >= range.first / 4; --v) relax<4>(v, b, x, true);
  });
}

void GaussSeidel::multiply(const float* x, float* y) const {
  const int B = rows_per_vertex_;
  for_each_task(true, [&](const Range& range) {
    for (int k = range.first; k < range.last; ++k) {
      QuadF sum = row_product(lower_, k, x) + row_product(upper_, k, x);
      const float* own = &own_[9 * B * static_cast<size_t>(k)];
      for (int n = 0; n < B; ++n) sum += product(own + 9 * n, x + kFloatsPerRow * static_cast<size_t>(k - k % B + n));
      sum.store(y + kFloatsPerRow * static_cast<size_t>(k));
    }
  });
}

void GaussSeidel::residual_after_forward(const float* x, float* r) const {
  for_each_task(true, [&](const Range& range) {
    for (int k = range.first; k < range.last; ++k)
      (QuadF::zero() - row_product(upper_, k, x)).store(r + kFloatsPerRow * static_cast<size_t>(k));
  });
}

}  // namespace aspic
