#include "mesh/generators.h"

#include <cstddef>
#include <utility>

#include "base/check.h"

namespace aspic {
namespace {

class Grid {
 public:
  explicit Grid(const std::array<int, 3>& cells) : cells_(cells) {}
  int vertex(int i, int j, int k) const { return (i * (cells_[1] + 1) + j) * (cells_[2] + 1) + k; }

 private:
  std::array<int, 3> cells_;
};

double coordinate(double lower, double upper, int i, int cells) {
  return i == cells ? upper : lower + (upper - lower) * i / cells;
}

// Walks from corner (i, j, k) to the opposite corner along the axes in all six orders. All tets share the main diagonal
// of the cell, and faces of neighboring cells match.
void add_kuhn_cell(const Grid& grid, int i, int j, int k, std::vector<Tet>& tets) {
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  constexpr bool kOdd[6] = {false, true, true, false, false, true};
  for (int order = 0; order < 6; ++order) {
    int corner[3] = {i, j, k};
    Tet tet = {grid.vertex(i, j, k), 0, 0, 0};
    for (int step = 0; step < 3; ++step) {
      ++corner[kOrders[order][step]];
      tet[step + 1] = grid.vertex(corner[0], corner[1], corner[2]);
    }
    if (kOdd[order]) std::swap(tet[2], tet[3]);
    tets.push_back(tet);
  }
}

// One regular tet on every other corner and four at the remaining corners, mirrored in every other cell so that the
// faces match.
void add_five_cell(const Grid& grid, int i, int j, int k, std::vector<Tet>& tets) {
  constexpr int kCut[5][4] = {{0, 3, 5, 6}, {1, 0, 3, 5}, {2, 3, 0, 6}, {4, 0, 5, 6}, {7, 5, 3, 6}};  // bits x y z
  const int mirror = (i + j + k) % 2;
  for (const auto& cut : kCut) {
    Tet tet;
    for (int c = 0; c < 4; ++c) {
      const int corner = cut[c] ^ mirror;
      tet[c] = grid.vertex(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2));
    }
    tets.push_back(tet);
  }
}

void orient(TetMesh& mesh) {
  for (int t = 0; t < mesh.tet_count(); ++t)
    if (volume(mesh, t) < 0) std::swap(mesh.tets[t][2], mesh.tets[t][3]);
}

}  // namespace

TetMesh make_box(const Vec3d& lower, const Vec3d& upper, const std::array<int, 3>& cells, BoxCut cut) {
  for (int axis = 0; axis < 3; ++axis) {
    ASPIC_CHECK(cells[axis] >= 1);
    ASPIC_CHECK(lower[axis] < upper[axis]);
  }
  const auto [nx, ny, nz] = cells;
  const Grid grid(cells);
  TetMesh mesh;
  mesh.rest.reserve(static_cast<size_t>(nx + 1) * (ny + 1) * (nz + 1));
  for (int i = 0; i <= nx; ++i)
    for (int j = 0; j <= ny; ++j)
      for (int k = 0; k <= nz; ++k)
        mesh.rest.push_back({coordinate(lower[0], upper[0], i, nx), coordinate(lower[1], upper[1], j, ny),
                             coordinate(lower[2], upper[2], k, nz)});
  mesh.tets.reserve(static_cast<size_t>(nx) * ny * nz * (cut == BoxCut::kuhn ? 6 : 5));
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k)
        cut == BoxCut::kuhn ? add_kuhn_cell(grid, i, j, k, mesh.tets) : add_five_cell(grid, i, j, k, mesh.tets);
  if (cut == BoxCut::five) orient(mesh);
  return mesh;
}

}  // namespace aspic
