// Elements with N vertices each: loops over them, and their blocks of the Hessian. Results are bit-reproducible for any
// number of threads.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <vector>

#include "base/parallel.h"
#include "energy/coloring.h"
#include "energy/energy.h"

namespace aspic {

// Consecutive elements form groups, see coloring.h. Threads share the work only if neighbors are close in the list.
class ElementGroups {
 public:
  ElementGroups() = default;
  template <size_t N>
  explicit ElementGroups(const std::vector<std::array<int, N>>& elements) : count_(static_cast<int>(elements.size())) {
    std::vector<std::vector<int>> vertices(group_count());
    int vertex_count = 0;
    for (int i = 0; i < count_; ++i)
      for (const int v : elements[i]) {
        vertices[i / kGroup].push_back(v);
        vertex_count = std::max(vertex_count, v + 1);
      }
    colors_ = color_groups(vertices, vertex_count);
  }

  // Calls body(element) for all elements. Those that run concurrently share no vertex.
  template <class Body>
  void for_each(const Body& body) const {
    for (const std::vector<int>& groups : colors_)
      parallel_for(static_cast<int>(groups.size()), [&](int k) {
        for (int i = groups[k] * kGroup; i < group_end(groups[k]); ++i) body(i);
      });
  }

  // The same for a body that returns whether it counts the element. Returns their number.
  template <class Body>
  int count_if(const Body& body) const {
    std::atomic<int> total = 0;
    for (const std::vector<int>& groups : colors_)
      parallel_for(static_cast<int>(groups.size()), [&](int k) {
        int counted = 0;
        for (int i = groups[k] * kGroup; i < group_end(groups[k]); ++i) counted += body(i);
        total += counted;
      });
    return total;
  }

 private:
  static constexpr int kGroup = 128;  // elements per group; they take a few microseconds
  int group_count() const { return (count_ + kGroup - 1) / kGroup; }
  int group_end(int group) const { return std::min(count_, (group + 1) * kGroup); }

  int count_ = 0;
  ColorClasses colors_;
};

// The blocks of an element in the lower triangle of the Hessian.
template <size_t N>
struct ElementBlocks {
  std::array<std::uint8_t, N> order;        // of the corners, by descending vertex
  std::array<int64_t, N*(N + 1) / 2> slot;  // blocks (order[i], order[j]), i <= j, row by row

  void bind(const std::array<int, N>& vertices, const BlockPattern& pattern) {
    std::iota(order.begin(), order.end(), std::uint8_t{0});
    std::sort(order.begin(), order.end(), [&](int u, int v) { return vertices[u] > vertices[v]; });
    for (size_t i = 0, k = 0; i < N; ++i)
      for (size_t j = i; j < N; ++j) slot[k++] = pattern.slot(vertices[order[i]], vertices[order[j]]);
  }

  // H += scale K, where block(u, v) returns the block of corners u and v.
  template <class Block>
  void add(const Block& block, double scale, BlockSparse& H) const {
    for (size_t i = 0, k = 0; i < N; ++i)
      for (size_t j = i; j < N; ++j, ++k) {
        const Mat3d& K = block(order[i], order[j]);
        double* a = H.block[slot[k]].a;
        for (int m = 0; m < 9; ++m) a[m] += scale * K.a[m];
      }
  }
};

template <size_t N>
void add_couplings(const std::array<int, N>& vertices, Couplings& couplings) {
  for (size_t i = 0; i < N; ++i)
    for (size_t j = 0; j < i; ++j) couplings.emplace_back(vertices[i], vertices[j]);
}

template <size_t N>
bool is_covered(const std::array<int, N>& vertices, const Projection& projection) {
  return std::any_of(vertices.begin(), vertices.end(), [&](int v) { return projection.covers(v); });
}

}  // namespace aspic
