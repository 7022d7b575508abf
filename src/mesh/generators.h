// Meshes of simple shapes. Lengths in m. Sizes must be positive and counts at least 1.
#pragma once
#include "mesh/tet_mesh.h"

namespace aspic {

enum class BoxCut {
  kuhn,  // six tets per cell (reflections of each other), conforming
  five,  // five tets per cell, mirrored in every other cell
};

// A box of cells and its tets, one at a time. Requires lower < upper and at least one cell per axis.
class BoxGrid {
 public:
  BoxGrid(const Vec3d& lower, const Vec3d& upper, const std::array<int, 3>& cells, BoxCut cut = BoxCut::kuhn);

  const std::array<int, 3>& cells() const { return cells_; }
  double vertex_count() const;  // may exceed the range of int
  double tet_count() const;
  int tets_per_cell() const { return cut_ == BoxCut::kuhn ? 6 : 5; }
  int vertex(int i, int j, int k) const { return (i * (cells_[1] + 1) + j) * (cells_[2] + 1) + k; }
  std::array<int, 3> corner(int vertex) const;  // i, j, k
  Vec3d position(int vertex) const;
  int cell(int i, int j, int k) const { return (i * cells_[1] + j) * cells_[2] + k; }
  // Appends the tets of a cell. Those of all cells, cell by cell, are those of make_box().
  void append_cell(int i, int j, int k, std::vector<Tet>& tets) const;

 private:
  Vec3d lower_, upper_;
  std::array<int, 3> cells_;
  BoxCut cut_;
};

// Meshes [lower, upper] with cells[0] x cells[1] x cells[2] cells. Vertex (i, j, k) has index (i (ny + 1) + j) (nz + 1)
// + k.
TetMesh make_box(const Vec3d& lower, const Vec3d& upper, const std::array<int, 3>& cells, BoxCut cut = BoxCut::kuhn);

// Round solids with edges of about `size` [m]. All volumes are positive. If `size` is at most the smallest dimension,
// the smallest dihedral angle is 33 degrees in the cylinder, 36 in the sphere, and 28, 23 and 10 in tori with minor /
// major radius = 0.3, 0.5 and 0.8.
TetMesh make_cylinder(double radius, double height, double size);           // axis z from 0 to height
TetMesh make_sphere(double radius, double size);                            // about the origin
TetMesh make_torus(double major_radius, double minor_radius, double size);  // about the z axis; minor < major

// Return the number of tets without meshing; infinite if no number of tets suffices.
double tets_in_cylinder(double radius, double height, double size);
double tets_in_torus(double major_radius, double minor_radius, double size);

}  // namespace aspic
