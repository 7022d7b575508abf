#include "energy/coloring.h"

#include <algorithm>
#include <cstdint>

namespace aspic {
namespace {

// Enough for threads to share a color; few enough for the memory of all fronts to fit into a cache.
constexpr int64_t kFronts = 8;

}  // namespace

// Divides the list into equal parts. A color gets the next group of each part, unless the group shares a vertex with a
// group of this color. Thus neighbors in the list have successive colors, while their shared data are in a cache. With
// the fewest possible colors, each color would pass over the whole mesh.
ColorClasses color_groups(std::span<const std::vector<int>> vertices_of_group, int vertex_count) {
  const int64_t groups = static_cast<int64_t>(vertices_of_group.size());
  std::vector<int> next, end;
  for (int64_t front = 0; front < kFronts; ++front) {
    next.push_back(static_cast<int>(front * groups / kFronts));
    end.push_back(static_cast<int>((front + 1) * groups / kFronts));
  }
  ColorClasses colors;
  std::vector<int> last_color(vertex_count, -1);  // last color with a group at each vertex
  for (int64_t left = groups; left > 0; left -= static_cast<int64_t>(colors.back().size())) {
    const int color = static_cast<int>(colors.size());
    std::vector<int>& members = colors.emplace_back();
    for (int64_t front = 0; front < kFronts; ++front) {
      if (next[front] == end[front]) continue;
      const std::vector<int>& vertices = vertices_of_group[next[front]];
      if (std::any_of(vertices.begin(), vertices.end(), [&](int v) { return last_color[v] == color; })) continue;
      for (const int v : vertices) last_color[v] = color;
      members.push_back(next[front]++);
    }
  }
  return colors;
}

}  // namespace aspic
