#include "mesh/chamber.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"

namespace aspic {
namespace {

// Triangulation of a disc or of some of its quarters; point i of ring j is at the angle i/j quarters.
class Sectors {
 public:
  explicit Sectors(const ChamberCells& cells) : rings_(cells.rings), quarters_(cells.quarters) {}

  bool is_closed() const { return quarters_ == 4; }
  int count_in(int ring) const { return ring == 0 ? 1 : quarters_ * ring + (is_closed() ? 0 : 1); }
  int first_of(int ring) const {
    return ring == 0 ? 0 : 1 + quarters_ * ring * (ring - 1) / 2 + (is_closed() ? 0 : ring - 1);
  }
  int point(int ring, int i) const { return ring == 0 ? 0 : first_of(ring) + (is_closed() ? i % (4 * ring) : i); }
  int point_count() const { return first_of(rings_) + count_in(rings_); }

  std::vector<Triangle> triangles() const {
    std::vector<Triangle> list;
    for (int j = 0; j < rings_; ++j)
      for (int q = 0; q < quarters_; ++q)
        for (int i = 0; i <= j; ++i) {
          const int in = q * j + i, out = q * (j + 1) + i;
          list.push_back({point(j, in), point(j + 1, out), point(j + 1, out + 1)});
          if (i < j) list.push_back({point(j, in), point(j + 1, out + 1), point(j, in + 1)});
        }
    return list;
  }

 private:
  int rings_, quarters_;
};

}  // namespace

Vec3d Chamber::point(double depth, double height, double angle) const {
  const double radius = inner_radius + depth * (outer_radius - inner_radius);
  const double length = inner_length + depth * (outer_length - inner_length);
  const double w = height * (std::numbers::pi - std::acos(base / length));
  return {{radius * std::sin(w) * std::cos(angle), radius * std::sin(w) * std::sin(angle), -length * std::cos(w)}};
}

// Vertex v of the disc has the indices v (layers + 1) to v (layers + 1) + layers. The diagonal of a prism's side joins
// its smaller vertex inside to the larger one outside, so that neighbors match.
TetMesh make_chamber(const Chamber& chamber, const ChamberCells& cells) {
  ASPIC_CHECK(cells.rings >= 1 && cells.layers >= 1 && cells.quarters >= 1 && cells.quarters <= 4);
  const Sectors sectors(cells);
  TetMesh mesh;
  for (int j = 0; j <= cells.rings; ++j)
    for (int i = 0; i < sectors.count_in(j); ++i)
      for (int s = 0; s <= cells.layers; ++s)
        mesh.rest.push_back(chamber.point(static_cast<double>(s) / cells.layers,
                                          std::pow(static_cast<double>(j) / cells.rings, cells.grading),
                                          j == 0 ? 0 : std::numbers::pi / 2 * i / j));
  for (Triangle triangle : sectors.triangles()) {
    std::sort(triangle.begin(), triangle.end());
    for (int s = 0; s < cells.layers; ++s) {
      const auto node = [&](int corner, int layer) { return triangle[corner] * (cells.layers + 1) + s + layer; };
      mesh.tets.push_back({node(0, 0), node(1, 0), node(2, 0), node(2, 1)});
      mesh.tets.push_back({node(0, 0), node(1, 0), node(1, 1), node(2, 1)});
      mesh.tets.push_back({node(0, 0), node(0, 1), node(1, 1), node(2, 1)});
    }
  }
  for (int t = 0; t < mesh.tet_count(); ++t)
    if (volume(mesh, t) < 0) std::swap(mesh.tets[t][2], mesh.tets[t][3]);
  return mesh;
}

ChamberCells chamber_cells(const Chamber& c, double size) {
  const double height = c.outer_length + c.base, wall = c.outer_radius - c.inner_radius;
  const double arc = std::hypot(height, c.outer_radius) * 1.1;  // from the tip to the base
  const auto count = [](double n) { return static_cast<int>(std::clamp(std::ceil(n), 1.0, 1e4)); };
  return {.rings = count(arc / size), .layers = count(wall / size)};
}

double tets_in_chamber(const Chamber& chamber, double size) {
  const ChamberCells cells = chamber_cells(chamber, size);
  return 12.0 * cells.rings * cells.rings * cells.layers;
}

}  // namespace aspic
