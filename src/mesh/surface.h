// Boundary surfaces of tetrahedral meshes.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Returns the triangles that belong to exactly one of tets [first, first + count), outward oriented, with vertex
// indices of the tet mesh, in a deterministic order.
std::vector<Triangle> boundary_triangles(const TetMesh& mesh, int first, int count);

struct BoundarySurface {
  TriMesh surface;              // only the boundary vertices
  std::vector<int> tet_vertex;  // vertex of the tet mesh for each surface vertex
};
BoundarySurface boundary_surface(const TetMesh& mesh);

}  // namespace aspic
