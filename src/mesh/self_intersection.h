// Self-intersections of a triangle surface.
#pragma once
#include <array>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct SelfIntersections {
  std::vector<std::array<int, 2>> pairs;  // ascending, sorted
  bool is_complete = true;                // false: pairs were omitted
};

// Finds pairs of triangles that share points other than common corners and edges. Vertices at the same position count
// as shared. Ignores degenerate, repeated and non-finite triangles. Costs O(n log n) unless the triangles cluster at
// one place. The search ends at `max_pairs` pairs, or after 1e8 comparisons.
SelfIntersections self_intersections(const TriMesh& mesh, int max_pairs = 1 << 20);

}  // namespace aspic
