// Distance between a point and a triangle or between two edges: closest points, type of the closest features, and the
// derivatives of functions of the distance.
#pragma once
#include <array>
#include <cstdint>

#include "math/definite.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// The features that contain the closest points.
enum class DistanceType : uint8_t { vertex_vertex, vertex_edge, vertex_face, edge_edge };

// The closest points of two primitives. Their difference is r = sum c_i x_i over the points of a stencil: the given
// points on which r depends. Stencils are (v, w), (v, e0, e1), (v, f0, f1, f2) and (a0, a1, b0, b1), each with r from
// the second feature to the first one. The weights are the barycentric coordinates of both points, with sum c_i = 0.
struct Distance {
  DistanceType type = DistanceType::vertex_vertex;
  int count = 2;                              // points of the stencil: 2, 3 or 4
  std::array<int, 4> point = {0, 1, -1, -1};  // their indices among the points of the query; -1 from `count` on
  std::array<double, 4> c = {1, -1, 0, 0};    // weights; 0 from `count` on
  Vec3d r = {};                               // [m]
  double d = 0;                               // |r| [m]
  std::array<Vec3d, 2> edge = {};             // dr/du_j for the count - 2 parameters u of the weights [m]

  Vec3d normal() const { return (1 / d) * r; }  // gradient of d: c_i normal(); requires d > 0
};

// Compute the distance of point x[0] from triangle x[1] x[2] x[3], of edge x[0] x[1] from edge x[2] x[3], and of point
// x[0] from edge x[1] x[2]. Accept degenerate triangles, edges of length zero and parallel edges; among equal distances
// the stencil with fewer points wins. The error of d is a few units of round-off of the largest difference of
// coordinates, wherever the origin is. Require finite
// coordinates and lengths that are 0 or between 1e-70 and 1e70.
Distance point_triangle_distance(const std::array<Vec3d, 4>& x);
Distance edge_edge_distance(const std::array<Vec3d, 4>& x);
Distance point_edge_distance(const std::array<Vec3d, 3>& x);

// The primitives of a pair, in the order of their points: x[0] and x[1]; x[0] and x[1] x[2]; x[0] and x[1] x[2] x[3];
// x[0] x[1] and x[2] x[3].
enum class PairKind : uint8_t { point_point, point_edge, point_triangle, edge_edge };

// Computes the distance of a pair of the given kind. Ignores the points beyond those of the kind.
Distance pair_distance(PairKind kind, const std::array<Vec3d, 4>& x);

// Lower triangle of the symmetric second derivative with respect to the points of a stencil.
struct DistanceHessian {
  std::array<Mat3d, 10> block = {};  // of points (i, j) for j <= i at i (i + 1) / 2 + j; zero from `count` on

  Mat3d& operator()(int i, int j) { return block[i * (i + 1) / 2 + j]; }
  const Mat3d& operator()(int i, int j) const { return block[i * (i + 1) / 2 + j]; }
};

// First and second derivative of a function b(d) of the distance at one d.
struct DistanceSlopes {
  double first, second;
};

// Returns the Hessian of b(d) in closed form. The type is constant in it: at a change of type the Hessian is one-sided.
// Requires d > 0, and edges that are not parallel for edge_edge.
DistanceHessian distance_hessian(const Distance& distance, const DistanceSlopes& b);

// The same with filtered eigenvalues: max(l, 0) or |l|. All eigenvectors with l != 0 lie in a space of at most five
// dimensions, so that the filter is exact at the cost of a 5 x 5 eigenproblem.
DistanceHessian filtered_distance_hessian(const Distance& distance, const DistanceSlopes& b, EigenvalueFilter filter);

// Orthonormal vectors orthogonal to the normal, as functions of the stencil alone. Requires d > 0.
std::array<Vec3d, 2> tangents(const Distance& distance);

}  // namespace aspic
