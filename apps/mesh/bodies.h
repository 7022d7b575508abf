// Splits a closed surface into the solid bodies that it bounds.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Returns one outer shell per body with the shells of its cavities, oriented outward from the material. Sheets inside a
// cavity are separate bodies. The order is that of the outer shells.
std::vector<TriMesh> bodies(const TriMesh& surface);

// Number of parts that are connected through shared edges.
int edge_connected_parts(const std::vector<Triangle>& triangles);

}  // namespace aspic
