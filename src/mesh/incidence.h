// Incident elements of each vertex.
#pragma once
#include <span>
#include <utility>
#include <vector>

namespace aspic {

struct Incidence {
  std::vector<int> start;    // offsets, vertex_count + 1 entries; empty: not built
  std::vector<int> element;  // incident elements of each vertex, in the given order

  Incidence() = default;
  Incidence(int vertex_count, std::span<const std::pair<int, int>> vertex_and_element);
  bool is_made() const { return !start.empty(); }
  std::span<const int> around(int vertex) const {
    return std::span(element).subspan(start[vertex], start[vertex + 1] - start[vertex]);
  }
};

}  // namespace aspic
