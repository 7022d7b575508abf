// Ball from the icosahedron: each of its 20 tets (center, face) is subdivided regularly, and the shells are projected
// onto spheres. The map is homogeneous along the radius, so quality does not depend on the number of shells.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "base/check.h"
#include "mesh/generators.h"

namespace aspic {
namespace {

constexpr double kGolden = std::numbers::phi;
constexpr double kCorners[12][3] = {{-1, kGolden, 0}, {1, kGolden, 0}, {-1, -kGolden, 0}, {1, -kGolden, 0},
                                    {0, -1, kGolden}, {0, 1, kGolden}, {0, -1, -kGolden}, {0, 1, -kGolden},
                                    {kGolden, 0, -1}, {kGolden, 0, 1}, {-kGolden, 0, -1}, {-kGolden, 0, 1}};
constexpr int kIcosahedronFaces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                          {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                          {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                          {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};

using Weights = std::array<int, 3>;  // weights of the corners of a face; their sum is the shell index, 0 at the center

class Ball {
 public:
  Ball(double radius, int shells) : radius_(radius), shells_(shells) {}

  TetMesh mesh() {
    for (const auto& face : kIcosahedronFaces)
      for (int i = 0; i < shells_; ++i)
        for (int j = 0; i + j < shells_; ++j)
          for (int k = 0; i + j + k < shells_; ++k) add_cells(face, {i, j, k});
    return std::move(mesh_);
  }

 private:
  // Adds the tets and octahedra of the regular subdivision with smallest weights w.
  void add_cells(const int (&face)[3], const Weights& w) {
    const auto [i, j, k] = w;
    const int above = shells_ - (i + j + k);  // remaining shells
    const int base = vertex(face, w), x = vertex(face, {i + 1, j, k}), y = vertex(face, {i, j + 1, k}),
              z = vertex(face, {i, j, k + 1});
    add_tet(base, x, y, z);
    if (above < 2) return;
    const int xy = vertex(face, {i + 1, j + 1, k}), yz = vertex(face, {i, j + 1, k + 1}),
              zx = vertex(face, {i + 1, j, k + 1});
    add_octahedron({x, yz}, {y, zx}, {z, xy});
    if (above < 3) return;
    add_tet(xy, yz, zx, vertex(face, {i + 1, j + 1, k + 1}));
  }

  // Adds four tets around the shortest of the three diagonals.
  void add_octahedron(std::array<int, 2> a, std::array<int, 2> b, std::array<int, 2> c) {
    if (squared_length(b) < squared_length(a)) std::swap(a, b);
    if (squared_length(c) < squared_length(a)) std::swap(a, c);
    for (int side = 0; side < 4; ++side) {
      const int from = side % 2 == 0 ? b[side / 2] : c[side / 2];
      const int to = side % 2 == 0 ? c[side / 2] : b[1 - side / 2];
      add_tet(a[0], a[1], from, to);
    }
  }

  void add_tet(int a, int b, int c, int d) {
    mesh_.tets.push_back({a, b, c, d});
    if (volume(mesh_, mesh_.tet_count() - 1) < 0) std::swap(mesh_.tets.back()[2], mesh_.tets.back()[3]);
  }

  double squared_length(const std::array<int, 2>& edge) const {
    const Vec3d along = mesh_.rest[edge[1]] - mesh_.rest[edge[0]];
    return dot(along, along);
  }

  int vertex(const int (&face)[3], const Weights& w) {
    std::array<std::pair<int, int>, 3> key = {};  // (corner + 1, weight); (0, 0) for a corner without weight
    for (int c = 0; c < 3; ++c)
      if (w[c] > 0) key[c] = {face[c] + 1, w[c]};
    std::sort(key.begin(), key.end());
    const auto [place, is_new] = index_.try_emplace(key, mesh_.vertex_count());
    if (is_new) mesh_.rest.push_back(position(key));
    return place->second;
  }

  Vec3d position(const std::array<std::pair<int, int>, 3>& key) const {
    Vec3d direction{};
    int shell = 0;
    for (const auto& [corner, weight] : key) {
      if (weight == 0) continue;
      const auto& p = kCorners[corner - 1];
      direction = direction + static_cast<double>(weight) * Vec3d{{p[0], p[1], p[2]}};
      shell += weight;
    }
    if (shell == 0) return {};
    return (radius_ * shell / shells_ / norm(direction)) * direction;
  }

  double radius_;
  int shells_;
  TetMesh mesh_;
  std::map<std::array<std::pair<int, int>, 3>, int> index_;
};

}  // namespace

TetMesh make_sphere(double radius, double size) {
  ASPIC_CHECK(radius > 0 && size > 0);
  return Ball(radius, std::max(1, static_cast<int>(std::lround(radius / size)))).mesh();
}

}  // namespace aspic
