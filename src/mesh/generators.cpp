#include "mesh/generators.h"

#include <cstddef>
#include <utility>

#include "base/check.h"

namespace aspic {
namespace {

double coordinate(double lower, double upper, int i, int cells) {
  return i == cells ? upper : lower + (upper - lower) * i / cells;
}

// Walks from corner (i, j, k) to the opposite corner along the axes in all six orders. All tets share the main diagonal
// of the cell, and faces of neighboring cells match.
void add_kuhn_cell(const BoxGrid& grid, int i, int j, int k, std::vector<Tet>& tets) {
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
void add_five_cell(const BoxGrid& grid, int i, int j, int k, std::vector<Tet>& tets) {
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

// Positively oriented.
void orient(const BoxGrid& grid, Tet& tet) {
  const TetMesh alone{
      {grid.position(tet[0]), grid.position(tet[1]), grid.position(tet[2]), grid.position(tet[3])}, {{0, 1, 2, 3}}, {}};
  if (volume(alone, 0) < 0) std::swap(tet[2], tet[3]);
}

}  // namespace

BoxGrid::BoxGrid(const Vec3d& lower, const Vec3d& upper, const std::array<int, 3>& cells, BoxCut cut)
    : lower_(lower), upper_(upper), cells_(cells), cut_(cut) {
  for (int axis = 0; axis < 3; ++axis) {
    ASPIC_CHECK(cells[axis] >= 1);
    ASPIC_CHECK(lower[axis] < upper[axis]);
  }
}

double BoxGrid::vertex_count() const { return (cells_[0] + 1.0) * (cells_[1] + 1.0) * (cells_[2] + 1.0); }
double BoxGrid::tet_count() const { return 1.0 * cells_[0] * cells_[1] * cells_[2] * tets_per_cell(); }

std::array<int, 3> BoxGrid::corner(int vertex) const {
  const int nz = cells_[2] + 1, ny = cells_[1] + 1;
  return {vertex / nz / ny, vertex / nz % ny, vertex % nz};
}

Vec3d BoxGrid::position(int vertex) const {
  const std::array<int, 3> at = corner(vertex);
  Vec3d X;
  for (int axis = 0; axis < 3; ++axis) X[axis] = coordinate(lower_[axis], upper_[axis], at[axis], cells_[axis]);
  return X;
}

void BoxGrid::append_cell(int i, int j, int k, std::vector<Tet>& tets) const {
  if (cut_ == BoxCut::kuhn) return add_kuhn_cell(*this, i, j, k, tets);
  const size_t first = tets.size();
  add_five_cell(*this, i, j, k, tets);
  for (size_t t = first; t < tets.size(); ++t) orient(*this, tets[t]);
}

TetMesh make_box(const Vec3d& lower, const Vec3d& upper, const std::array<int, 3>& cells, BoxCut cut) {
  const BoxGrid grid(lower, upper, cells, cut);
  const auto [nx, ny, nz] = cells;
  TetMesh mesh;
  const int vertices = static_cast<int>(grid.vertex_count());
  mesh.rest.reserve(vertices);
  for (int v = 0; v < vertices; ++v) mesh.rest.push_back(grid.position(v));
  mesh.tets.reserve(static_cast<size_t>(grid.tet_count()));
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) grid.append_cell(i, j, k, mesh.tets);
  return mesh;
}

}  // namespace aspic
