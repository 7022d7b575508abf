// Exact orientation predicates: a floating-point filter, and exact arithmetic where it cannot decide. Valid unless
// products of three coordinates overflow or underflow. [Shewchuk 1997]
#pragma once
#include <array>

#include "mesh/tet_mesh.h"

namespace aspic {

// Sign of det [a - d, b - d, c - d]: +1 if triangle abc is clockwise as seen from d; 0: coplanar.
int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);

using Vec2d = std::array<double, 2>;
// Sign of det [a - c, b - c]: +1 if a, b, c are counter-clockwise; 0: collinear.
int orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c);

}  // namespace aspic
