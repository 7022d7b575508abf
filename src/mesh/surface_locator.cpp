#include "mesh/surface_locator.h"

#include <cmath>
#include <limits>
#include <vector>

#include "mesh/distance.h"
#include "mesh/triangle_shape.h"

namespace aspic {
namespace {

std::vector<Box> boxes(std::span<const Vec3d> vertices, std::span<const Triangle> triangles) {
  std::vector<Box> boxes(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t)
    for (const int v : triangles[t]) boxes[t].add(vertices[v]);
  return boxes;
}

// Weights of the corners that give the point p of the triangle abc.
std::array<double, 3> weights_at(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d n = cross(b - a, c - a);
  const double nn = dot(n, n);
  const double v = dot(cross(p - a, c - a), n) / nn, w = dot(cross(b - a, p - a), n) / nn;
  if (v > -1e-6 && w > -1e-6 && v + w < 1 + 1e-6) return {1 - v - w, v, w};
  std::array<double, 3> weights{};  // the triangle is flat
  const Distance distance = point_triangle_distance({p, a, b, c});
  for (int i = 0; i < distance.count; ++i)
    if (distance.point[i] > 0) weights[distance.point[i] - 1] = -distance.c[i];
  return weights;
}

}  // namespace

SurfaceLocator::SurfaceLocator(std::span<const Vec3d> vertices, std::span<const Triangle> triangles)
    : vertices_(vertices), triangles_(triangles), tree_(boxes(vertices, triangles)) {}

ClosestPoint SurfaceLocator::nearest(const Vec3d& p) const {
  ClosestPoint best;
  double reach = std::numeric_limits<double>::infinity();
  tree_.for_each_near(p, reach, [&](int t) {
    const auto& [a, b, c] = triangles_[t];
    const Vec3d q = nearest_point(p, vertices_[a], vertices_[b], vertices_[c]);
    const double distance = dot(q - p, q - p);
    if (distance < reach || (distance == reach && t < best.triangle))
      best.triangle = t, best.position = q, reach = distance;
  });
  const auto& [a, b, c] = triangles_[best.triangle];
  best.weights = weights_at(best.position, vertices_[a], vertices_[b], vertices_[c]);
  best.distance = std::sqrt(reach);
  return best;
}

}  // namespace aspic
