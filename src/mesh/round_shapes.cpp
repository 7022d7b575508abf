// Cylinder and torus: a disc swept along a line or a circle.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"
#include "mesh/disc.h"
#include "mesh/generators.h"

namespace aspic {
namespace {

constexpr double kMaxPieces = 1e9;  // maximum counted pieces, far beyond any memory

double counted(double length, double size) { return std::max(1.0, std::round(length / size)); }

int pieces(double length, double size) {
  const double count = counted(length, size);
  ASPIC_CHECK(count <= kMaxPieces);
  return static_cast<int>(std::min(count, kMaxPieces));
}

// The disc has six sectors of n^2 triangles; each prism has three tets.
double tets_swept(double rings, double layers) { return 18 * rings * rings * layers; }

double copies_round(double major_radius, double size) {
  return std::max(6.0, counted(2 * std::numbers::pi * major_radius, size));
}

}  // namespace

double tets_in_cylinder(double radius, double height, double size) {
  return tets_swept(counted(radius, size), counted(height, size));
}

double tets_in_torus(double major_radius, double minor_radius, double size) {
  return tets_swept(counted(minor_radius, size), copies_round(major_radius, size));
}

TetMesh make_cylinder(double radius, double height, double size) {
  ASPIC_CHECK(radius > 0 && height > 0 && size > 0);
  const Disc disc = make_disc(pieces(radius, size));
  const int layers = pieces(height, size);
  TetMesh mesh;
  for (int layer = 0; layer <= layers; ++layer)
    for (const auto& [x, y] : disc.points)
      mesh.rest.push_back({radius * x, radius * y, layer == layers ? height : height * layer / layers});
  mesh.tets = swept_tets(disc, layers + 1, false);
  return mesh;
}

// All tets have positive volumes for any size: with the disc in the plane of angle s and its copy rotated by t < pi,
// the volume of each tet is sin(t)/3 times the area of its triangle times the distance of one corner from the axis.
TetMesh make_torus(double major_radius, double minor_radius, double size) {
  ASPIC_CHECK(minor_radius > 0 && minor_radius < major_radius && size > 0);
  const Disc disc = make_disc(pieces(minor_radius, size));
  const int copies = std::max(6, pieces(2 * std::numbers::pi * major_radius, size));
  TetMesh mesh;
  for (int copy = 0; copy < copies; ++copy) {
    const double angle = -2 * std::numbers::pi * copy / copies;  // the disc's normal (r x z) points along -angle
    for (const auto& [x, y] : disc.points) {
      const double r = major_radius + minor_radius * x;
      mesh.rest.push_back({r * std::cos(angle), r * std::sin(angle), minor_radius * y});
    }
  }
  mesh.tets = swept_tets(disc, copies, true);
  return mesh;
}

}  // namespace aspic
