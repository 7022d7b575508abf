// Corners of a surface that agree up to rounding, as along the seams of files with few digits.
#pragma once
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

inline constexpr double kCornerTolerance = 1e-6;  // relative to the diagonal of the bounding box

// Largest distance of corners that agree [m].
double corner_tolerance(const TriMesh& mesh);

// For each vertex, returns the first one that agrees with it if both are on open edges, otherwise itself. Requires
// valid indices.
std::vector<int> first_agreeing_corner(const TriMesh& mesh);

}  // namespace aspic
