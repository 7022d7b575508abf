// The boundary of a tetrahedral mesh.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Returns the triangles that belong to exactly one of tets [first, first + count), outward oriented, with vertex
// indices of the tet mesh, in a deterministic order.
std::vector<Triangle> boundary_triangles(const TetMesh& mesh, int first, int count);

struct BoundarySurface {
  TriMesh surface;              // only the vertices on the boundary
  std::vector<int> tet_vertex;  // surface vertex -> vertex of the tet mesh
};
BoundarySurface boundary_surface(const TetMesh& mesh);

}  // namespace aspic
