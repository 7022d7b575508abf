#include "mesh/disc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"

namespace aspic {
namespace {

// Index of point i (modulo the ring size) of ring k.
int ring_point(int k, int i) { return k == 0 ? 0 : 1 + 3 * k * (k - 1) + i % (6 * k); }

}  // namespace

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

}  // namespace aspic
