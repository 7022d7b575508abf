#include "energy/load_points.h"

#include <array>

#include "energy/quadratic_batch.h"
#include "energy/quadratic_face.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

template <size_t N>
std::vector<int> listed(const std::array<int, N>& nodes) {
  return {nodes.begin(), nodes.end()};
}

}  // namespace

void append_load_points(const TetMesh& mesh, int tet, std::vector<LoadPoint>& points) {
  const TetNodes nodes = nodes_of(mesh, tet);
  const double size = volume(mesh, tet) / 4;
  if (nodes.count == 4) {
    points.push_back({centroid(mesh, tet), {}, listed(mesh.tets[tet]), size, std::vector<double>(4, 1)});
    return;
  }
  const TetCorners X = corners(mesh, tet);
  for (int q = 0; q < 4; ++q) {
    LoadPoint point{{}, {}, listed(nodes.node), size, {}};
    std::array<double, 4> l;
    for (int c = 0; c < 4; ++c) {
      l[c] = point_coordinate(q, c);
      point.position = point.position + l[c] * X[c];
    }
    for (const double shape : quadratic_shapes(l)) point.shares.push_back(shape);
    points.push_back(std::move(point));
  }
}

void append_load_points(const std::vector<Vec3d>& X, const Face& face, std::vector<LoadPoint>& points) {
  const auto& [a, b, c] = face.corners;
  const Vec3d n = cross(X[b] - X[a], X[c] - X[a]);
  const double size = norm(n) / 2 / 3;
  if (!face.is_quadratic()) {
    points.push_back({(1.0 / 3) * (X[a] + X[b] + X[c]), n, listed(face.corners), size, std::vector<double>(3, 1)});
    return;
  }
  for (int q = 0; q < 3; ++q) {  // the shape functions of the corners have the integral 0
    std::array<double, 3> l = {1.0 / 6, 1.0 / 6, 1.0 / 6};
    l[q] = 2.0 / 3;
    LoadPoint point{l[0] * X[a] + l[1] * X[b] + l[2] * X[c], n, listed(nodes_of(face)), size, {}};
    for (const double shape : face_shapes(l)) point.shares.push_back(shape);
    points.push_back(std::move(point));
  }
}

void add_load(const LoadPoint& point, const Vec3d& load, std::span<double> force) {
  const Vec3d f = point.size * load;
  for (size_t n = 0; n < point.nodes.size(); ++n)
    for (int r = 0; r < 3; ++r) force[3 * point.nodes[n] + r] += point.shares[n] * f[r];
}

}  // namespace aspic
