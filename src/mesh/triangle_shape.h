// Triangles in space: the nearest point, and whether two of them meet.
#pragma once
#include "mesh/tet_mesh.h"

namespace aspic {

using TriangleCorners = std::array<Vec3d, 3>;

// The point of triangle abc nearest to p. [Ericson 2005, section 5.1.5]
Vec3d nearest_point(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

// Thinner than the round-off of its coordinates: it has no normal.
bool is_degenerate(const TriangleCorners& triangle);

// Whether the triangles have a point in common. Touching counts. Exact, for triangles not degenerate.
bool meet(const TriangleCorners& s, const TriangleCorners& t);

// For triangles with s[0] = t[0]: whether they have another point in common.
bool meet_beyond_vertex(const TriangleCorners& s, const TriangleCorners& t);

// For triangles with s[0] = t[0] and s[1] = t[1]: whether they lie in a plane, on the same side of the common edge.
bool meet_beyond_edge(const TriangleCorners& s, const TriangleCorners& t);

}  // namespace aspic
