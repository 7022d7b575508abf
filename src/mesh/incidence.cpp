#include "mesh/incidence.h"

#include <numeric>

namespace aspic {

Incidence::Incidence(int vertex_count, std::span<const std::pair<int, int>> vertex_and_element)
    : start(vertex_count + 1, 0), element(vertex_and_element.size()) {
  for (const auto& [vertex, e] : vertex_and_element) ++start[vertex + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (const auto& [vertex, e] : vertex_and_element) element[next[vertex]++] = e;
}

}  // namespace aspic
