#include "energy/coloring.h"

namespace aspic {

// Greedy: each group takes the first colour that none of its vertices has seen.
ColorClasses color_groups(std::span<const std::vector<int>> vertices_of_group, int vertex_count) {
  ColorClasses colors;
  std::vector<std::vector<int>> colors_of_vertex(vertex_count);
  std::vector<int> taken_by;  // per colour, the last group that may not use it
  for (int group = 0; group < static_cast<int>(vertices_of_group.size()); ++group) {
    for (const int v : vertices_of_group[group])
      for (const int color : colors_of_vertex[v]) taken_by[color] = group;
    int color = 0;
    while (color < static_cast<int>(colors.size()) && taken_by[color] == group) ++color;
    if (color == static_cast<int>(colors.size())) {
      colors.emplace_back();
      taken_by.push_back(-1);
    }
    colors[color].push_back(group);
    for (const int v : vertices_of_group[group])
      if (colors_of_vertex[v].empty() || colors_of_vertex[v].back() != color) colors_of_vertex[v].push_back(color);
  }
  return colors;
}

}  // namespace aspic
