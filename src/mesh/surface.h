// Boundary surfaces of tetrahedral meshes.
#pragma once
#include <span>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// A face of a tet, outward oriented.
struct Face {
  Triangle corners;
  Triangle mids = {-1, -1, -1};  // mid-edge nodes after each corner; -1 for a linear tet

  bool is_quadratic() const { return mids[0] >= 0; }
};

std::vector<Face> linear_faces(std::span<const Triangle> triangles);

// Returns the faces that belong to exactly one of tets [first, first + count), in a deterministic order.
std::vector<Face> boundary_faces(const TetMesh& mesh, int first, int count);

// Joins boundary triangles of a mesh to faces: a quadratic one for all its four triangles, else linear ones.
std::vector<Face> faces_of(const TetMesh& mesh, std::span<const Triangle> triangles);

// Returns these faces as triangles with vertex indices of the tet mesh: one for each linear face, and four between the
// nodes of each quadratic one.
std::vector<Triangle> boundary_triangles(const TetMesh& mesh, int first, int count);

struct BoundarySurface {
  TriMesh surface;              // only the boundary vertices
  std::vector<int> tet_vertex;  // vertex of the tet mesh for each surface vertex
};
BoundarySurface boundary_surface(const TetMesh& mesh);  // of all tets, and the sheets

// Returns the boundary faces of all tets, then the triangles of the sheets.
std::vector<Face> surface_faces(const TetMesh& mesh);

}  // namespace aspic
