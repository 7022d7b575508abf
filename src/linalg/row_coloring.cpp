#include "linalg/row_coloring.h"

#include "linalg/graph.h"

namespace aspic {

std::vector<std::vector<int>> color_rows(const BlockPattern& pattern) {
  const std::vector<int> color = greedy_coloring(graph_of(pattern));
  std::vector<std::vector<int>> rows_of_color;
  for (int row = 0; row < pattern.rows(); ++row) {
    if (color[row] >= static_cast<int>(rows_of_color.size())) rows_of_color.resize(color[row] + 1);
    rows_of_color[color[row]].push_back(row);
  }
  return rows_of_color;
}

}  // namespace aspic
