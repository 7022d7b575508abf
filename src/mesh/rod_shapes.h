// Polylines of rods. Lengths in m.
#pragma once
#include "mesh/tet_mesh.h"

namespace aspic {

// All return vertices and rods without radius, with segments of about `size`.
TetMesh make_line(const Vec3d& from, const Vec3d& to, double size);
TetMesh make_ring(double radius, double size);  // closed, about the z axis in the plane z = 0
// About the z axis from (radius, 0, 0) upward, right-handed. `pitch`: height of a turn.
TetMesh make_helix(double radius, double pitch, double turns, double size);

// Return the number of segments without meshing.
double segments_in_line(double length, double size);
double segments_in_ring(double radius, double size);

// Returns the segments chain by chain, each from end to end, oriented as the first of its segments that is an end if
// possible. `segments` name vertices below `vertex_count`. Throws InvalidInput where more than two segments meet, for
// segments between equal vertices, and for closed chains of fewer than three segments.
std::vector<Segment> chained(int vertex_count, const std::vector<Segment>& segments);

}  // namespace aspic
