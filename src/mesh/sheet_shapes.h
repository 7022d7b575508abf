// Triangle meshes of sheets, with nearly equilateral triangles: their hinges prefer no direction as those of squares
// that are cut in two do. Lengths in m, positive.
#pragma once
#include "mesh/tet_mesh.h"

namespace aspic {

// All have edges of about `size` and normals along z, or outward.
TriMesh make_rectangle(double width, double height, double size);  // about the origin, width along x, height along y
TriMesh make_disc(double radius, double size);                     // about the origin, in the plane z = 0
TriMesh make_tube(double radius, double height, double size);      // about the z axis, from 0 to height, open

// Return the number of triangles without meshing.
double triangles_in_rectangle(double width, double height, double size);
double triangles_in_disc(double radius, double size);
double triangles_in_tube(double radius, double height, double size);

}  // namespace aspic
