#include "contact/obstacle_surface.h"

#include <cmath>
#include <numbers>

#include "mesh/box.h"
#include "mesh/distance.h"

namespace aspic {
namespace {

constexpr double kExtent = 2;  // half the side of the square of a plane, relative to the size of the bodies

// Returns a square around the point below the bodies.
TriMesh square(const ContactPlane& plane, const Box& bodies) {
  const Vec3d center = 0.5 * (bodies.lower + bodies.upper);
  const Vec3d foot = center - dot(plane.normal, center - plane.origin) * plane.normal;
  const double half = kExtent * norm(bodies.upper - bodies.lower);
  const auto [u, v] = tangents({.r = plane.normal, .d = 1});
  const Vec3d a = half * u, b = half * v;
  return {{foot - a - b, foot + a - b, foot + a + b, foot - a + b}, {{0, 1, 2}, {0, 2, 3}}};
}

// Triangulates rings from one end of a capsule to the other.
TriMesh capsule(const Vec3d& a, const Vec3d& b, double radius) {
  constexpr int kAround = 32, kRings = 16;  // rings: even
  const Vec3d axis = norm(b - a) > 0 ? (1 / norm(b - a)) * (b - a) : Vec3d{{0, 1, 0}};
  const auto [u, v] = tangents({.r = axis, .d = 1});
  TriMesh mesh;
  for (int i = 0; i <= kRings + 1; ++i) {
    const int step = i <= kRings / 2 ? i : i - 1;  // the equator occurs twice, at both ends
    const double polar = std::numbers::pi * step / kRings;
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * k / kAround;
      const Vec3d out = std::cos(angle) * u + std::sin(angle) * v;
      mesh.vertices.push_back((i <= kRings / 2 ? a : b) + radius * (std::sin(polar) * out - std::cos(polar) * axis));
      if (i == 0) continue;
      const int here = i * kAround + k, next = i * kAround + (k + 1) % kAround;
      mesh.triangles.push_back({here - kAround, next - kAround, next});
      mesh.triangles.push_back({here - kAround, next, here});
    }
  }
  return mesh;
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
    if (part.is_round) {
      own.surface = capsule(points[part.first_point], points[part.first_point + part.point_count - 1], part.offset);
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
