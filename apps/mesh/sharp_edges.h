// Sharp edges of a surface, which the mesher keeps exactly.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Chains of edges whose triangles meet at more than 50 degrees, from corner to corner or closed. Chains with a free end
// that are shorter than half of `size` are left out, as are chains that meet at less than 20 degrees, and all chains of
// a surface that is rough rather than sharp.
std::vector<std::vector<Vec3d>> sharp_chains(const TriMesh& body, double size);

// Whether two triangles meet at less than 20 degrees, inside of the body.
bool has_blade(const TriMesh& body);

}  // namespace aspic
