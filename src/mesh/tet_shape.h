// Shape measures of a tetrahedron, and its distance from a point.
#pragma once
#include <array>

#include "mesh/tet_mesh.h"

namespace aspic {

using TetCorners = std::array<Vec3d, 4>;

inline TetCorners corners(const TetMesh& mesh, int tet) {
  const auto& [a, b, c, d] = mesh.tets[tet];
  return {mesh.rest[a], mesh.rest[b], mesh.rest[c], mesh.rest[d]};
}

// Corners of the face opposite each corner, counter-clockwise seen from outside a positively oriented tet.
inline constexpr int kTetFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

inline Vec3d centroid(const TetCorners& X) { return 0.25 * ((X[0] + X[1]) + (X[2] + X[3])); }
inline Vec3d centroid(const TetMesh& mesh, int tet) { return centroid(corners(mesh, tet)); }

inline double signed_volume(const TetCorners& X) {
  return determinant(from_columns(X[1] - X[0], X[2] - X[0], X[3] - X[0])) / 6;
}

// Gradients of the four linear shape functions [1/m].
std::array<Vec3d, 4> shape_gradients(const TetCorners& corners);

double longest_edge(const TetCorners& corners);

// Returns the smallest and largest dihedral angle at the six edges [degrees]; 0 and 180 for a flat tet.
std::array<double, 2> dihedral_range(const TetCorners& corners);

// Returns the mean ratio 12 (3 V)^(2/3) / sum of squared edges: 1 for a regular tet, 0 for a flat one, negative for an
// inverted one [Liu and Joe 1994].
double mean_ratio(const TetCorners& corners);

double total_volume(const TetMesh& mesh);  // [m^3]

// Returns the threshold below which volumes are at the round-off level of the corners: the tet counts as flat.
double flat_volume(const TetCorners& corners);

// Returns the barycentric coordinates of p, which sum to 1. Requires a tet that is not flat.
std::array<double, 4> barycentric(const TetCorners& corners, const Vec3d& p);

// Returns the squared distance [m^2] from p to the tet, 0 inside. w: barycentric coordinates of p.
double squared_distance(const TetCorners& corners, const std::array<double, 4>& w, const Vec3d& p);

}  // namespace aspic
