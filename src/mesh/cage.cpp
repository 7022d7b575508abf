#include "mesh/cage.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"
#include "mesh/box.h"
#include "mesh/generators.h"

namespace aspic {
namespace {

class Cubes {
 public:
  Cubes(const Box& box, double size) {
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = box.upper[axis] - box.lower[axis];
      cells_[axis] = static_cast<int>(std::clamp(std::ceil(extent / size), 1.0, kMostCubes + 1));
      lower_[axis] = box.lower[axis] - kMargin * size;
      edge_[axis] = (extent + 2 * kMargin * size) / cells_[axis];
      upper_[axis] = lower_[axis] + cells_[axis] * edge_[axis];
    }
    if (1.0 * cells_[0] * cells_[1] * cells_[2] > kMostCubes)
      throw InvalidInput("the box around the surface has more than " + three_digits(kMostCubes) +
                         " cubes; choose larger ones than " + three_digits(size) + " m");
    kept_.assign(static_cast<size_t>(cells_[0]) * cells_[1] * cells_[2], 0);
  }

  void keep_around(const TriMesh& surface) {
    for (const auto& [a, b, c] : surface.triangles) {
      const Vec3d &A = surface.vertices[a], &B = surface.vertices[b], &C = surface.vertices[c];
      const double longest = std::sqrt(std::max({squared_norm(B - A), squared_norm(C - B), squared_norm(A - C)}));
      const int parts = 1 + static_cast<int>(longest / (kSpacing * std::min({edge_[0], edge_[1], edge_[2]})));
      for (int i = 0; i <= parts; ++i)
        for (int j = 0; i + j <= parts; ++j)
          kept_[index_of(A + (1.0 * i / parts) * (B - A) + (1.0 * j / parts) * (C - A))] = 1;
    }
  }

  // A center is inside if a ray along z has crossed the surface an odd number of times.
  void keep_inside(const TriMesh& surface) {
    std::vector<std::vector<double>> crossings(static_cast<size_t>(cells_[0]) * cells_[1]);
    for (const auto& [a, b, c] : surface.triangles)
      add_crossings(surface.vertices[a], surface.vertices[b], surface.vertices[c], crossings);
    for (size_t column = 0; column < crossings.size(); ++column) {
      std::vector<double>& z = crossings[column];
      std::sort(z.begin(), z.end());
      for (int k = 0; k < cells_[2]; ++k) {
        const auto below = std::lower_bound(z.begin(), z.end(), lower_[2] + (k + 0.5) * edge_[2]) - z.begin();
        if (below % 2 == 1) kept_[column * cells_[2] + k] = 1;
      }
    }
  }

  TetMesh tets() const {
    const TetMesh all = make_box(lower_, upper_, cells_);
    TetMesh mesh;
    std::vector<int> vertex(all.vertex_count(), -1);
    for (Tet tet : all.tets) {
      Vec3d center = {};
      for (const int v : tet) center = center + 0.25 * all.rest[v];
      if (!kept_[index_of(center)]) continue;
      for (int& v : tet) {
        if (vertex[v] < 0) {
          vertex[v] = mesh.vertex_count();
          mesh.rest.push_back(all.rest[v]);
        }
        v = vertex[v];
      }
      mesh.tets.push_back(tet);
    }
    return mesh;
  }

 private:
  static constexpr double kMostCubes = 1e6;
  static constexpr double kMargin = 1e-3;   // around the surface, in edges
  static constexpr double kSpacing = 0.25;  // between the points of the surface that are looked up, in edges
  // Rays avoid the vertices and edges of regular surfaces.
  static constexpr double kOffset[2] = {0.5 + 1.234e-5, 0.5 - 2.718e-5};

  int cell(double x, int axis) const {
    return std::clamp(static_cast<int>((x - lower_[axis]) / edge_[axis]), 0, cells_[axis] - 1);
  }
  size_t index_of(const Vec3d& x) const {
    return (static_cast<size_t>(cell(x[0], 0)) * cells_[1] + cell(x[1], 1)) * cells_[2] + cell(x[2], 2);
  }

  void add_crossings(const Vec3d& A, const Vec3d& B, const Vec3d& C,
                     std::vector<std::vector<double>>& crossings) const {
    int first[2], last[2];
    for (int axis = 0; axis < 2; ++axis) {
      first[axis] = cell(std::min({A[axis], B[axis], C[axis]}), axis);
      last[axis] = cell(std::max({A[axis], B[axis], C[axis]}), axis);
    }
    const double area = (B[0] - A[0]) * (C[1] - A[1]) - (B[1] - A[1]) * (C[0] - A[0]);
    if (area == 0) return;
    for (int i = first[0]; i <= last[0]; ++i)
      for (int j = first[1]; j <= last[1]; ++j) {
        const double x = lower_[0] + (i + kOffset[0]) * edge_[0], y = lower_[1] + (j + kOffset[1]) * edge_[1];
        const double v = ((x - A[0]) * (C[1] - A[1]) - (y - A[1]) * (C[0] - A[0])) / area;
        const double w = ((B[0] - A[0]) * (y - A[1]) - (B[1] - A[1]) * (x - A[0])) / area;
        if (v < 0 || w < 0 || v + w > 1) continue;
        crossings[static_cast<size_t>(i) * cells_[1] + j].push_back(A[2] + v * (B[2] - A[2]) + w * (C[2] - A[2]));
      }
  }

  std::array<int, 3> cells_;
  Vec3d lower_, upper_, edge_;
  std::vector<char> kept_;
};

}  // namespace

TetMesh make_cage(const TriMesh& surface, double size) {
  const Box box = bounding_box(surface.vertices);
  for (int axis = 0; axis < 3; ++axis)
    if (!(box.upper[axis] > box.lower[axis])) return {};
  Cubes cubes(box, size);
  cubes.keep_around(surface);
  cubes.keep_inside(surface);
  return cubes.tets();
}

}  // namespace aspic
