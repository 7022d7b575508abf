#include "mesh/tet_shape.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "mesh/triangle_shape.h"

namespace aspic {
namespace {

constexpr int kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
constexpr int kOppositeEdges[6][2] = {{2, 3}, {3, 1}, {1, 2}, {0, 3}, {2, 0}, {0, 1}};

}  // namespace

std::array<Vec3d, 4> shape_gradients(const TetCorners& X) {
  const Mat3d G = inverse(from_columns(X[1] - X[0], X[2] - X[0], X[3] - X[0]));  // rows: gradients of 1, 2, 3
  std::array<Vec3d, 4> gradients{};
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      gradients[i + 1][axis] = G(i, axis);
      gradients[0][axis] -= G(i, axis);
    }
  return gradients;
}

double longest_edge(const TetCorners& X) {
  double longest = 0;
  for (const auto& [a, b] : kEdges) longest = std::max(longest, norm(X[b] - X[a]));
  return longest;
}

std::array<double, 2> dihedral_range(const TetCorners& X) {
  double smallest = std::numbers::pi, largest = 0;
  for (int e = 0; e < 6; ++e) {
    const Vec3d edge = X[kEdges[e][1]] - X[kEdges[e][0]];
    const Vec3d m = cross(edge, X[kOppositeEdges[e][0]] - X[kEdges[e][0]]);
    const Vec3d n = cross(edge, X[kOppositeEdges[e][1]] - X[kEdges[e][0]]);
    const double angle = std::atan2(norm(cross(m, n)), dot(m, n));
    smallest = std::min(smallest, angle);
    largest = std::max(largest, angle);
  }
  const double degrees = 180 / std::numbers::pi;
  return {smallest * degrees, largest * degrees};
}

double mean_ratio(const TetCorners& X) {
  double sum = 0;
  for (const auto& [a, b] : kEdges) sum += dot(X[b] - X[a], X[b] - X[a]);
  if (sum == 0) return 0;
  const double root = std::cbrt(3 * signed_volume(X));
  return 12 * root * std::abs(root) / sum;
}

double total_volume(const TetMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) sum += volume(mesh, t);
  return sum;
}

double flat_volume(const TetCorners& X) {
  double size = 0;
  for (const Vec3d& x : X) size = std::max({size, std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
  // Each entry of the determinant has the round-off of a coordinate times edges.
  const double edge = longest_edge(X);
  return 4 * std::numeric_limits<double>::epsilon() * std::max(size, edge) * edge * edge;
}

std::array<double, 4> barycentric(const TetCorners& X, const Vec3d& p) {
  const Vec3d w = inverse(from_columns(X[1] - X[0], X[2] - X[0], X[3] - X[0])) * (p - X[0]);
  return {1 - w[0] - w[1] - w[2], w[0], w[1], w[2]};
}

double squared_distance(const TetCorners& X, const std::array<double, 4>& w, const Vec3d& p) {
  double nearest = 0;
  bool is_outside = false;
  for (int corner = 0; corner < 4; ++corner) {
    if (w[corner] >= 0) continue;  // p is not beyond the face opposite to this corner
    const auto& [a, b, c] = kTetFaces[corner];
    const Vec3d away = p - nearest_point(p, X[a], X[b], X[c]);
    nearest = is_outside ? std::min(nearest, dot(away, away)) : dot(away, away);
    is_outside = true;
  }
  return nearest;
}

}  // namespace aspic
