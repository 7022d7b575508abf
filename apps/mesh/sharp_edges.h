// Sharp edges of a surface, which the mesher preserves.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Returns chains of edges whose triangles meet at more than 50 degrees, from corner to corner or closed. Omits chains
// with a free end that are shorter than half of `size`, chains that meet at less than 20 degrees, and all chains of a
// surface that is rough rather than sharp.
std::vector<std::vector<Vec3d>> sharp_chains(const TriMesh& body, double size);

// Whether two triangles meet at less than 20 degrees inside the body.
bool has_blade(const TriMesh& body);

}  // namespace aspic
