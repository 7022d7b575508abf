// Which triangles of a surface run into each other.
#pragma once
#include <array>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Pairs (ascending, sorted) of triangles with a point in common other than the corners and edges they share. Vertices
// at the same place count as shared. Degenerate and repeated triangles, and those not finite, are left out. O(n log n)
// for surfaces whose triangles are not all in one place; the search ends at `most` pairs.
std::vector<std::array<int, 2>> self_intersections(const TriMesh& mesh, int most = 1 << 20);

}  // namespace aspic
