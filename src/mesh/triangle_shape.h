// Triangles in space: nearest points and intersection tests.
#pragma once
#include "mesh/tet_mesh.h"

namespace aspic {

using TriangleCorners = std::array<Vec3d, 3>;

// The point of triangle abc nearest to p. [Ericson 2005, section 5.1.5]
Vec3d nearest_point(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

// True if the triangle is thinner than the round-off of its coordinates, so that it has no normal.
bool is_degenerate(const TriangleCorners& triangle);

// Whether the triangles intersect. Touching counts. Exact for triangles that are not degenerate.
bool meet(const TriangleCorners& s, const TriangleCorners& t);

// For triangles with s[0] = t[0]: whether they have another common point.
bool meet_beyond_vertex(const TriangleCorners& s, const TriangleCorners& t);

// For triangles with s[0] = t[0] and s[1] = t[1]: whether they are coplanar, on the same side of the common edge.
bool meet_beyond_edge(const TriangleCorners& s, const TriangleCorners& t);

}  // namespace aspic
