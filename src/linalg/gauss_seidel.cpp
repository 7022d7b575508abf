#include "linalg/gauss_seidel.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <numeric>

#include "base/check.h"
#include "base/parallel.h"
#include "math/lanes.h"

namespace aspic {
namespace {

// Minimum multiplications (about 0.1 ns each) per task, and per color for which sharing the loop between threads
// outweighs waking them.
constexpr double kWorkPerTask = 12'000, kWorkWorthSharing = 40'000;
constexpr int kPrefetchAhead = 4096;  // bytes; saves 6 % on the benchmark beam of 95 000 vertices

struct Entry {
  int column, source;
};

std::vector<int> groups_by_color(std::span<const int> color) {
  std::vector<int> order(color.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return color[a] < color[b]; });
  return order;
}

}  // namespace

// A block is column-major, without gaps: unused lanes of a vector hold values of the next column.
template <int B>
struct GaussSeidel::Kernel {
  using Vector = Lanes<float, kFloatsPerRow * B>;
  static constexpr int kSize = 3 * B, kFloats = kFloatsPerRow * B;
  static constexpr int64_t kBlock = kSize * kSize;  // floats of a block

  static Vector product(const float* A, const float* x) {
    Vector even = Vector::load(A) * Vector::all(x[0]), odd = Vector::load(A + kSize) * Vector::all(x[1]);
    for (int j = 2; j + 1 < kSize; j += 2) {
      even += Vector::load(A + kSize * j) * Vector::all(x[j]);
      odd += Vector::load(A + kSize * (j + 1)) * Vector::all(x[j + 1]);
    }
    if (kSize % 2 == 1) even += Vector::load(A + kSize * (kSize - 1)) * Vector::all(x[kSize - 1]);
    return even + odd;
  }

  static Vector row_product(const Triangle& t, int vertex, const float* x) {
    const auto term = [&](int64_t s) {
      return product(&t.value[kBlock * s], x + kFloats * static_cast<int64_t>(t.column[s]));
    };
    Vector even = Vector::zero(), odd = Vector::zero();
    int64_t s = t.start[vertex];
    const int64_t end = t.start[vertex + 1];
    for (; s + 1 < end; s += 2) even += term(s), odd += term(s + 1);
    if (s < end) even += term(s);
    return even + odd;
  }

  // Prefetches the blocks of a row that is visited later, `bytes` after those of this row.
  static void prefetch_row(const Triangle& t, int vertex, std::ptrdiff_t bytes) {
    const char* first = reinterpret_cast<const char*>(t.value.data() + kBlock * t.start[vertex]) + bytes;
    const char* last = reinterpret_cast<const char*>(t.value.data() + kBlock * t.start[vertex + 1]) + bytes;
    for (const char* p = first; p < last; p += 64) __builtin_prefetch(p);
  }

  static void relax(const GaussSeidel& gs, int v, const float* b, float* x, bool upper_too) {
    prefetch_row(gs.lower_, v, upper_too ? -kPrefetchAhead : kPrefetchAhead);
    if (upper_too) prefetch_row(gs.upper_, v, -kPrefetchAhead);
    Vector s = Vector::load(b + kFloats * static_cast<int64_t>(v)) - row_product(gs.lower_, v, x);
    if (upper_too) s -= row_product(gs.upper_, v, x);
    float residual[kFloats];
    s.store(residual);
    product(&gs.inverse_[kBlock * v], residual).store(x + kFloats * static_cast<int64_t>(v));
  }

  using Dense = Eigen::Matrix<double, kSize, kSize>;
  static void write(const Dense& A, float* to) {
    for (int j = 0; j < kSize; ++j)
      for (int i = 0; i < kSize; ++i) to[kSize * j + i] = static_cast<float>(A(i, j));
  }

  static Dense own_block(const BlockSparse& H, int v) {
    const BlockPattern& p = *H.pattern;
    Dense A;
    for (int m = 0; m < B; ++m)
      for (int n = 0; n <= m; ++n) {
        const double* block = H.block[p.diagonal(B * v + m) - m + n].a;
        for (int k = 0; k < 9; ++k) A(3 * m + k % 3, 3 * n + k / 3) = A(3 * n + k / 3, 3 * m + k % 3) = block[k];
      }
    return A;
  }

  static bool load_own(GaussSeidel& gs, const BlockSparse& H, int k) {
    const Dense A = own_block(H, gs.order_[k]);
    const Eigen::LLT<Dense> factor(A);
    if (factor.info() != Eigen::Success) return false;
    write(A, &gs.own_[kBlock * k]);
    write(factor.solve(Dense::Identity()), &gs.inverse_[kBlock * k]);
    return true;
  }

  static void load(GaussSeidel& gs, const BlockSparse& H, Triangle& t, int k) {
    const auto& start = H.pattern->row_start;
    for (int64_t s = t.start[k]; s < t.start[k + 1]; ++s) {
      const bool is_transposed = t.source[s] < 0;
      const int64_t slot = is_transposed ? ~t.source[s] : t.source[s];
      const int row = B * gs.order_[is_transposed ? t.column[s] : k];
      float* to = &t.value[kBlock * s];
      for (int m = 0; m < B; ++m)
        for (int n = 0; n < B; ++n) {
          const double* from = H.block[slot + start[row + m] - start[row] + n].a;
          if (is_transposed)
            copy_block<true>(from, to + 3 * kSize * m + 3 * n);
          else
            copy_block<false>(from, to + 3 * kSize * n + 3 * m);
        }
    }
  }

  template <bool kTransposed>
  static void copy_block(const double* from, float* to) {
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        to[kSize * c + r] = static_cast<float>(kTransposed ? from[c + 3 * r] : from[r + 3 * c]);
  }
};

template <class Body>
void GaussSeidel::with_kernel(const Body& body) const {
  if (rows_per_vertex_ == 1)
    body(Kernel<1>());
  else
    body(Kernel<4>());
}

template <class Body>
void GaussSeidel::for_each_task(bool ascending, const Body& body) const {
  const int colors = static_cast<int>(tasks_.size());
  for (int c = 0; c < colors; ++c) {
    const std::vector<Range>& tasks = tasks_[ascending ? c : colors - 1 - c];
    if (tasks.empty()) continue;
    if ((tasks.back().last - tasks.front().first) * work_per_vertex_ >= kWorkWorthSharing)
      parallel_for(static_cast<int>(tasks.size()), [&](int t) { body(tasks[t]); });
    else
      for (const Range& range : tasks) body(range);
  }
}

void GaussSeidel::analyze(const BlockPattern& p, int rows_per_vertex, std::span<const int> group,
                          std::span<const int> color_of_group) {
  const int vertices = p.rows() / rows_per_vertex, groups = static_cast<int>(color_of_group.size());
  ASPIC_CHECK(rows_per_vertex == 1 || rows_per_vertex == 4);
  ASPIC_CHECK(static_cast<int>(group.size()) == vertices && p.block_count() <= INT32_MAX);
  rows_per_vertex_ = rows_per_vertex;
  work_per_vertex_ = 9.0 * (2.0 * static_cast<double>(p.block_count()) - p.rows()) / std::max(1, vertices);

  std::vector<int> size(groups, 0);
  for (const int g : group)
    if (g >= 0) ++size[g];
  const int colors = groups == 0 ? 0 : 1 + *std::max_element(color_of_group.begin(), color_of_group.end());
  range_.assign(groups, {});
  tasks_.assign(colors + 1, {});
  int next = 0;
  for (const int g : groups_by_color(color_of_group)) {
    std::vector<Range>& tasks = tasks_[color_of_group[g]];
    if (tasks.empty() || (tasks.back().last - tasks.back().first) * work_per_vertex_ >= kWorkPerTask)
      tasks.push_back({next, next});
    range_[g] = {next, next + size[g]};
    tasks.back().last = next += size[g];
  }
  if (next < vertices) tasks_[colors].push_back({next, vertices});

  std::vector<int> place(groups), position(vertices);
  for (int g = 0; g < groups; ++g) place[g] = range_[g].first;
  order_.resize(vertices);
  for (int v = 0; v < vertices; ++v) {
    position[v] = group[v] >= 0 ? place[group[v]]++ : next++;
    order_[position[v]] = v;
  }

  for (Triangle* t : {&lower_, &upper_}) {
    t->start.assign(1, 0);
    t->column.clear(), t->source.clear();
  }
  std::vector<Entry> entries;
  for (int k = 0; k < vertices; ++k) {
    const int row = order_[k] * rows_per_vertex, last = row + rows_per_vertex;
    entries.clear();
    for (int64_t s = p.row_start[row]; s < p.diagonal(row); s += rows_per_vertex)
      entries.push_back({position[p.column[s] / rows_per_vertex], static_cast<int>(s)});
    for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u)
      if (p.upper_row[u] >= last && p.upper_row[u] % rows_per_vertex == 0)
        entries.push_back({position[p.upper_row[u] / rows_per_vertex], ~static_cast<int>(p.upper_slot[u])});
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
    for (const Entry& entry : entries) {
      Triangle& t = entry.column < k ? lower_ : upper_;
      t.column.push_back(entry.column);
      t.source.push_back(entry.source);
    }
    for (Triangle* t : {&lower_, &upper_}) t->start.push_back(static_cast<int64_t>(t->column.size()));
  }
  with_kernel([&](auto kernel) {
    // load() writes all blocks
    const auto reserve = [&](LargeVector<float>& values, size_t blocks) {
      values.resize(kernel.kBlock * blocks + kSpareLanes);
      std::fill(values.end() - kSpareLanes, values.end(), 0.0F);
    };
    for (Triangle* t : {&lower_, &upper_}) reserve(t->value, t->column.size());
    for (LargeVector<float>* v : {&own_, &inverse_}) reserve(*v, static_cast<size_t>(vertices));
  });
}

bool GaussSeidel::load(const BlockSparse& H) {
  std::atomic<bool> is_definite = true;
  with_kernel([&](auto kernel) {
    parallel_chunks(static_cast<int>(order_.size()), [&](int first, int last) {
      for (int k = first; k < last; ++k) {
        if (!kernel.load_own(*this, H, k)) is_definite = false;
        kernel.load(*this, H, lower_, k);
        kernel.load(*this, H, upper_, k);
      }
    });
  });
  return is_definite;
}

void GaussSeidel::sweep_forward(const float* b, float* x) const {
  with_kernel([&](auto kernel) {
    for_each_task(true, [&](const Range& range) {
      for (int v = range.first; v < range.last; ++v) kernel.relax(*this, v, b, x, false);
    });
  });
}

void GaussSeidel::sweep_backward(const float* b, float* x) const {
  with_kernel([&](auto kernel) {
    for_each_task(false, [&](const Range& range) {
      for (int v = range.last - 1; v >= range.first; --v) kernel.relax(*this, v, b, x, true);
    });
  });
}

void GaussSeidel::residual_after_forward(const float* x, float* r) const {
  with_kernel([&](auto kernel) {
    using Vector = typename decltype(kernel)::Vector;
    for_each_task(true, [&](const Range& range) {
      for (int v = range.first; v < range.last; ++v)
        (Vector::zero() - kernel.row_product(upper_, v, x)).store(r + kernel.kFloats * static_cast<int64_t>(v));
    });
  });
}

void GaussSeidel::multiply_after_backward(const float* b, float* before, const float* x, float* y) const {
  with_kernel([&](auto kernel) {
    using Vector = typename decltype(kernel)::Vector;
    const auto at = [&](int v) { return kernel.kFloats * static_cast<int64_t>(v); };
    for_each_task(true, [&](const Range& range) {
      for (int v = range.first; v < range.last; ++v)
        (Vector::load(before + at(v)) - Vector::load(x + at(v))).store(before + at(v));
    });
    for_each_task(true, [&](const Range& range) {
      for (int v = range.first; v < range.last; ++v)
        (Vector::load(b + at(v)) - kernel.row_product(lower_, v, before)).store(y + at(v));
    });
  });
}

}  // namespace aspic
