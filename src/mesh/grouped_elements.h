// Groups elements with equal vertex sets, in linear time.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace aspic {

template <size_t N>
struct GroupedElement {
  std::array<int, N> vertices;  // ascending
  int place;                    // the caller's element index
};

namespace detail {

template <size_t N>
std::array<int, N> ascending(std::array<int, N> v) {
  for (size_t i = 1; i < N; ++i)
    for (size_t j = i; j > 0 && v[j - 1] > v[j]; --j) std::swap(v[j - 1], v[j]);
  return v;
}

// Compares elements with equal first vertices.
template <size_t N>
bool is_less(const GroupedElement<N>& a, const GroupedElement<N>& b) {
  for (size_t i = 1; i < N; ++i)
    if (a.vertices[i] != b.vertices[i]) return a.vertices[i] < b.vertices[i];
  return a.place < b.place;
}

template <size_t N>
bool are_same(const GroupedElement<N>& a, const GroupedElement<N>& b) {
  for (size_t i = 0; i < N; ++i)
    if (a.vertices[i] != b.vertices[i]) return false;
  return true;
}

}  // namespace detail

// Returns the elements sorted by vertices, then by place. `for_each(visit)` must call visit(vertices, place) for every
// element. It is called twice and must repeat the same calls. Vertices are in [0, vertex_count).
template <size_t N, class ForEach>
std::vector<GroupedElement<N>> grouped_elements(int vertex_count, const ForEach& for_each) {
  std::vector<int64_t> start(static_cast<size_t>(vertex_count) + 1, 0);
  for_each([&](const std::array<int, N>& v, int) {
    ++start[static_cast<size_t>(*std::min_element(v.begin(), v.end())) + 1];
  });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<GroupedElement<N>> elements(static_cast<size_t>(start.back()));
  std::vector<int64_t> next(start.begin(), start.end() - 1);
  for_each([&](const std::array<int, N>& v, int place) {
    const std::array<int, N> sorted = detail::ascending(v);
    elements[static_cast<size_t>(next[sorted[0]]++)] = {sorted, place};
  });
  parallel_chunks(vertex_count, [&](int first, int last) {
    for (int v = first; v < last; ++v)
      std::sort(elements.begin() + start[v], elements.begin() + start[v + 1], detail::is_less<N>);
  });
  return elements;
}

// Calls visit(begin, end) for the elements of each vertex set.
template <size_t N, class Visit>
void for_each_group(const std::vector<GroupedElement<N>>& elements, const Visit& visit) {
  for (size_t begin = 0, end; begin < elements.size(); begin = end) {
    for (end = begin + 1; end < elements.size() && detail::are_same(elements[end], elements[begin]);) ++end;
    visit(elements.data() + begin, elements.data() + end);
  }
}

}  // namespace aspic
