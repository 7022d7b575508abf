// Groups of elements that may scatter at the same time: no two groups of one color share a vertex. Colors are worked
// through in order, so every vertex receives its contributions in an order that does not depend on the threads.
#pragma once
#include <span>
#include <vector>

namespace aspic {

using ColorClasses = std::vector<std::vector<int>>;  // the groups of each color, ascending

// vertices_of_group[i] lists the vertices that group i touches; repeats allowed.
ColorClasses color_groups(std::span<const std::vector<int>> vertices_of_group, int vertex_count);

}  // namespace aspic
