// Colors groups of elements such that no two groups of one color share a vertex, so that groups of one color may add to
// shared vectors concurrently. Colors are processed in order, so the summation order at each vertex is independent of
// the number of threads.
#pragma once
#include <span>
#include <vector>

namespace aspic {

using ColorClasses = std::vector<std::vector<int>>;  // the groups of each color, ascending

// Returns the groups of each color. vertices_of_group[i] lists the vertices of group i; repeats allowed.
ColorClasses color_groups(std::span<const std::vector<int>> vertices_of_group, int vertex_count);

}  // namespace aspic
