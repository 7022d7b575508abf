// Orientation signs that are never wrong: a floating-point filter, and exact arithmetic where it cannot decide.
// Exact unless products of three coordinates overflow or underflow. [Shewchuk 1997]
#pragma once
#include <array>

#include "mesh/tet_mesh.h"

namespace aspic {

// Sign of det [a - d, b - d, c - d]: +1 when d sees the triangle abc turn clockwise; 0: the four lie in a plane.
int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);

using Vec2d = std::array<double, 2>;
// Sign of det [a - c, b - c]: +1 when a, b, c turn counter-clockwise; 0: they lie on a line.
int orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c);

}  // namespace aspic
