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

// Triangulates rings between the poles of a capsule; its equator occurs at both ends.
TriMesh capsule(const Vec3d& a, const Vec3d& b, double radius) {
  constexpr int kAround = 32, kRings = 16;  // kRings: angles from pole to pole, even
  const double length = norm(b - a);
  const Vec3d axis = length > 0 ? (1 / length) * (b - a) : Vec3d{{0, 1, 0}};
  const auto frame = tangents({.r = axis, .d = 1});
  const Vec3d u = frame[0], v = frame[1];
  TriMesh mesh;
  const auto add_ring = [&](const Vec3d& center, double polar) {
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * k / kAround;
      const Vec3d out = std::cos(angle) * u + std::sin(angle) * v;
      mesh.vertices.push_back(center + radius * (std::sin(polar) * out - std::cos(polar) * axis));
    }
  };
  mesh.vertices.push_back(a - radius * axis);
  for (int i = 1; i < kRings; ++i) {
    const double polar = std::numbers::pi * i / kRings;
    if (i <= kRings / 2) add_ring(a, polar);
    if (i > kRings / 2 || (i == kRings / 2 && length > 0)) add_ring(b, polar);
  }
  const int last = mesh.vertex_count();  // the other pole
  mesh.vertices.push_back(b + radius * axis);
  for (int ring = 1; ring < last; ring += kAround)
    for (int k = 0; k < kAround; ++k) {
      const int here = ring + k, next = ring + (k + 1) % kAround;
      const bool is_first = ring == 1, is_last = ring + kAround == last;
      mesh.triangles.push_back({is_first ? 0 : here - kAround, next, here});
      mesh.triangles.push_back({here, next, is_last ? last : next + kAround});
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
