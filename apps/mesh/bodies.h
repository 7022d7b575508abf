// The solid bodies that a closed surface bounds.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// One outer shell and the shells of its cavities, facing out of the material. Sheets of the surface that lie in a
// cavity are bodies of their own. In the order of the outer shells.
std::vector<TriMesh> bodies(const TriMesh& surface);

// Parts that hang together through shared edges.
int edge_connected_parts(const std::vector<Triangle>& triangles);

}  // namespace aspic
