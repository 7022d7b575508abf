#include "data/surface_projection.h"

#include "mesh/surface.h"

namespace aspic {

SurfaceProjection::SurfaceProjection(const TetMesh& mesh)
    : mesh_(mesh), triangles_(boundary_triangles(mesh, 0, mesh.tet_count())), locator_(mesh.rest, triangles_) {}

ProjectedPoint SurfaceProjection::nearest(const Vec3d& p) const {
  const ClosestPoint closest = locator_.nearest(p);
  const auto& [a, b, c] = triangles_[closest.triangle];
  const auto& X = mesh_.rest;
  const Vec3d n = cross(X[b] - X[a], X[c] - X[a]);
  return {{triangles_[closest.triangle], closest.weights}, closest.position, (1 / norm(n)) * n, closest.distance};
}

Vec3d position(const SurfacePoint& point, const std::vector<Vec3d>& X) {
  Vec3d p{};
  for (int i = 0; i < 3; ++i) p = p + point.weights[i] * X[point.vertices[i]];
  return p;
}

}  // namespace aspic
