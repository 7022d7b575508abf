// Elements of a mesh: its tets, then the triangles of its sheets, then the segments of its rods.
#pragma once
#include <span>
#include <string>

#include "mesh/tet_mesh.h"

namespace aspic {

// Returns the rest shape of a triangle: its pattern, or its corners.
std::array<Vec3d, 3> rest_corners(const TetMesh& mesh, int triangle);

double element_volume(const TetMesh& mesh, int element);  // at rest; of a sheet: area times thickness [m^3]
Vec3d element_center(const TetMesh& mesh, int element);   // centroid at rest [m]

double element_quality(const TetMesh& mesh,
                       int element);  // mean ratio: 1 for equal edges, 0 for a flat one; 1 for a segment

// Returns F at the centroid, where it is the mean over the element. A triangle keeps its thickness, a segment its
// cross-section. x: 3 per vertex [m].
Mat3d deformation_gradient(const TetMesh& mesh, int element, std::span<const double> x);

std::string size_text(const TetMesh& mesh);  // "12 vertices, 5 tets"

// Appends the vertices, tets, sheets with their patterns and rods of a body. Bodies without labels get the region 0.
void append(const TetMesh& body, TetMesh& all);

}  // namespace aspic
