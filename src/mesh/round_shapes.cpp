// Cylinder and torus: a disc swept along a line or a circle.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/check.h"
#include "mesh/generators.h"
#include "mesh/tet_mesh.h"

namespace aspic {
namespace {

// A disc of concentric rings, from which the cylinder and the torus are swept.
// Ring k of `rings` has 6 k points at radius k / rings; triangles are counter-clockwise in the (x, y) plane. All angles
// are at least 30 degrees for any number of rings.
struct Disc {
  std::vector<std::array<double, 2>> points;  // points of the unit disc
  std::vector<Triangle> triangles;
};

// Index of point i (modulo the ring size) of ring k.
int ring_point(int k, int i) { return k == 0 ? 0 : 1 + 3 * k * (k - 1) + i % (6 * k); }

Disc make_disc(int rings) {
  ASPIC_CHECK(rings >= 1);
  Disc disc;
  disc.points.push_back({0, 0});
  for (int k = 1; k <= rings; ++k) {
    for (int i = 0; i < 6 * k; ++i) {
      const double angle = std::numbers::pi * i / (3 * k), radius = static_cast<double>(k) / rings;
      disc.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    for (int sector = 0; sector < 6; ++sector) {
      for (int s = 0; s < k; ++s) {
        const int outer = sector * k + s, inner = sector * (k - 1) + s;
        disc.triangles.push_back({ring_point(k, outer), ring_point(k, outer + 1), ring_point(k - 1, inner)});
        if (s + 1 < k)
          disc.triangles.push_back({ring_point(k, outer + 1), ring_point(k - 1, inner + 1), ring_point(k - 1, inner)});
      }
    }
  }
  return disc;
}

// Returns the prisms between copies of the disc, three tets each. Vertex v of copy k has index k * points + v. With
// `closed` the last copy is joined to the first. The diagonal of a prism's side joins its smaller disc vertex below to
// the larger one above, so that neighbors match.
std::vector<Tet> swept_tets(const Disc& disc, int copies, bool closed) {
  ASPIC_CHECK(copies >= (closed ? 3 : 2));
  const int points = static_cast<int>(disc.points.size());
  std::vector<Tet> tets;
  for (int copy = 0; copy + (closed ? 0 : 1) < copies; ++copy) {
    const int below = copy * points, above = (copy + 1) % copies * points;
    for (Triangle triangle : disc.triangles) {
      // Rotates the corners so that a is the smallest, which keeps the orientation.
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
      const auto [a, b, c] = triangle;
      tets.push_back({below + a, above + b, above + c, above + a});
      if (b < c) {
        tets.push_back({below + a, below + b, below + c, above + c});
        tets.push_back({below + a, below + b, above + c, above + b});
      } else {
        tets.push_back({below + a, below + b, below + c, above + b});
        tets.push_back({below + a, above + b, below + c, above + c});
      }
    }
  }
  return tets;
}

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
