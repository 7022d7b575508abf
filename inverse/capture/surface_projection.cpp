#include "capture/surface_projection.h"

#include <cmath>
#include <limits>

#include "mesh/surface.h"
#include "mesh/triangle_shape.h"

namespace aspic {
namespace {

std::vector<Box> boxes(const TetMesh& mesh, const std::vector<Triangle>& triangles) {
  std::vector<Box> boxes(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t)
    for (const int v : triangles[t]) boxes[t].add(mesh.rest[v]);
  return boxes;
}

// Weights of the corners that give the point p of the triangle abc.
std::array<double, 3> weights_at(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d n = cross(b - a, c - a);
  const double nn = dot(n, n);
  const double v = dot(cross(p - a, c - a), n) / nn, w = dot(cross(b - a, p - a), n) / nn;
  return {1 - v - w, v, w};
}

}  // namespace

SurfaceProjection::SurfaceProjection(const TetMesh& mesh)
    : mesh_(mesh), triangles_(boundary_triangles(mesh, 0, mesh.tet_count())), tree_(boxes(mesh, triangles_)) {}

ProjectedPoint SurfaceProjection::nearest(const Vec3d& p) const {
  int best = 0;
  Vec3d foot{};
  double reach = std::numeric_limits<double>::infinity();
  tree_.for_each_near(p, reach, [&](int t) {
    const auto& [a, b, c] = triangles_[t];
    const Vec3d q = nearest_point(p, mesh_.rest[a], mesh_.rest[b], mesh_.rest[c]);
    const double distance = dot(q - p, q - p);
    if (distance < reach || (distance == reach && t < best)) best = t, foot = q, reach = distance;
  });
  const auto& [a, b, c] = triangles_[best];
  const auto& X = mesh_.rest;
  const Vec3d n = cross(X[b] - X[a], X[c] - X[a]);
  return {{triangles_[best], weights_at(foot, X[a], X[b], X[c])}, foot, (1 / norm(n)) * n, std::sqrt(reach)};
}

Vec3d position(const SurfacePoint& point, const std::vector<Vec3d>& X) {
  Vec3d p{};
  for (int i = 0; i < 3; ++i) p = p + point.weights[i] * X[point.vertices[i]];
  return p;
}

}  // namespace aspic
