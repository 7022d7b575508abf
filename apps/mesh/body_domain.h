// One body with its sharp edges and edge lengths, for Mesh_3.
#pragma once
#include <vector>

#include "local_size.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct BodyDomain {
  const TriMesh& surface;
  const LocalSize& size;
  std::vector<std::vector<Vec3d>> sharp;  // chains of points whose edges are preserved
  std::vector<Vec3d> seeds;               // points of the surface from which refinement starts
  size_t most_vertices = 0;               // at which refinement stops
  bool has_blade = false;                 // a body with a blade has slivers, whose optimization needs minutes
};

// Returns no tets if none fits.
TetMesh fill_body(const BodyDomain& body);

}  // namespace aspic
