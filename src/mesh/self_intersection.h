// Which triangles of a surface run into each other.
#pragma once
#include <array>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct SelfIntersections {
  std::vector<std::array<int, 2>> pairs;  // ascending, sorted
  bool is_complete = true;                // no pair was left out
};

// Pairs of triangles with a point in common other than the corners and edges they share. Vertices
// at the same place count as shared. Degenerate and repeated triangles, and those not finite, are left out. O(n log n)
// for surfaces whose triangles are not all in one place; the search ends at `most` pairs, or when it has compared 1e8.
SelfIntersections self_intersections(const TriMesh& mesh, int most = 1 << 20);

}  // namespace aspic
