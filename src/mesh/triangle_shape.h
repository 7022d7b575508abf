// Triangles in space: the nearest point, and whether two of them meet.
#pragma once
#include "mesh/tet_mesh.h"

namespace aspic {

// The point of triangle abc nearest to p. [Ericson 2005, section 5.1.5]
Vec3d nearest_point(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

}  // namespace aspic
