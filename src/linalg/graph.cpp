#include "linalg/graph.h"

#include <algorithm>

#include "base/check.h"

namespace aspic {

Graph graph_of(const BlockPattern& p) {
  Graph graph;
  graph.start.resize(p.rows() + 1);
  graph.neighbor.reserve(2 * (p.block_count() - p.rows()));
  for (int row = 0; row < p.rows(); ++row) {
    const auto column = p.column.begin();
    graph.neighbor.insert(graph.neighbor.end(), column + p.row_start[row], column + p.diagonal(row));
    const auto upper = p.upper_row.begin();
    graph.neighbor.insert(graph.neighbor.end(), upper + p.upper_start[row], upper + p.upper_start[row + 1]);
    graph.start[row + 1] = static_cast<int64_t>(graph.neighbor.size());
  }
  return graph;
}

Graph quotient(const Graph& graph, std::span<const int> group, int groups) {
  ASPIC_CHECK(static_cast<int>(group.size()) == graph.vertex_count());
  std::vector<std::vector<int>> members(groups);
  for (int v = 0; v < graph.vertex_count(); ++v)
    if (group[v] >= 0) members[group[v]].push_back(v);
  Graph result;
  result.start.assign(1, 0);
  std::vector<int> seen(groups, -1);
  for (int g = 0; g < groups; ++g) {
    seen[g] = g;
    for (const int v : members[g])
      for (const int w : graph.around(v)) {
        const int other = group[w];
        if (other < 0 || seen[other] == g) continue;
        seen[other] = g;
        result.neighbor.push_back(other);
      }
    std::sort(result.neighbor.begin() + result.start.back(), result.neighbor.end());
    result.start.push_back(static_cast<int64_t>(result.neighbor.size()));
  }
  return result;
}

std::vector<int> greedy_coloring(const Graph& graph) {
  std::vector<int> color(graph.vertex_count(), -1), used_by;  // for each color, the last vertex with a neighbor of it
  for (int v = 0; v < graph.vertex_count(); ++v) {
    for (const int w : graph.around(v))
      if (color[w] >= 0) used_by[color[w]] = v;
    size_t first = 0;
    while (first < used_by.size() && used_by[first] == v) ++first;
    if (first == used_by.size()) used_by.push_back(-1);
    color[v] = static_cast<int>(first);
  }
  return color;
}

}  // namespace aspic
