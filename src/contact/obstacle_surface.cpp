#include "contact/obstacle_surface.h"

#include "mesh/box.h"
#include "mesh/distance.h"

namespace aspic {
namespace {

constexpr double kExtent = 2;  // half the side of the square of a plane / size of the bodies

// The square around the point below the bodies.
TriMesh square(const ContactPlane& plane, const Box& bodies) {
  const Vec3d center = 0.5 * (bodies.lower + bodies.upper);
  const Vec3d foot = center - dot(plane.normal, center - plane.origin) * plane.normal;
  const double half = kExtent * norm(bodies.upper - bodies.lower);
  const auto [u, v] = tangents({.r = plane.normal, .d = 1});
  const Vec3d a = half * u, b = half * v;
  return {{foot - a - b, foot + a - b, foot + a + b, foot - a + b}, {{0, 1, 2}, {0, 2, 3}}};
}

}  // namespace

std::vector<ObstacleSurface> obstacle_surfaces(const ContactMesh& mesh, std::span<const Vec3d> points) {
  Box bodies;
  for (int p = 0; p < mesh.point_count(); ++p)
    if (mesh.row[p] >= 0) bodies.add(mesh.rest[p]);
  std::vector<ObstacleSurface> surfaces;
  for (size_t k = 0; k < mesh.parts.size(); ++k) {
    const ContactPart& part = mesh.parts[k];
    if (!part.is_obstacle) continue;
    ObstacleSurface& own = surfaces.emplace_back(ObstacleSurface{.name = part.name, .is_moving = bool(part.motion)});
    for (const ContactPlane& plane : mesh.planes)
      if (plane.part == static_cast<int>(k)) own.plane = plane, own.plane->origin = points[plane.point];
    if (own.plane) {
      own.surface = square(*own.plane, bodies);
      continue;
    }
    const auto first = points.begin() + part.first_point;
    own.surface.vertices.assign(first, first + part.point_count);
    for (const auto& [a, b, c] : mesh.triangles)
      if (mesh.part[a] == static_cast<int>(k))
        own.surface.triangles.push_back({a - part.first_point, b - part.first_point, c - part.first_point});
  }
  return surfaces;
}

}  // namespace aspic
