// Meshes of tets, sheets and rods at rest, and triangle meshes, as plain data without adjacency or physics.
#pragma once
#include <array>
#include <vector>

#include "math/small.h"

namespace aspic {

using Tet = std::array<int, 4>;
using Triangle = std::array<int, 3>;
using Segment = std::array<int, 2>;
using MidNodes = std::array<int, 6>;  // one per edge of a tet, see kTetEdges

struct TetMesh {
  std::vector<Vec3d> rest;  // X, one per vertex [m]
  std::vector<Tet> tets;    // positively oriented: volume(mesh, t) > 0
  std::vector<int> region;  // label of each tet; empty if the mesh has none
  // Mid-edge nodes of quadratic tets, one entry per tet, {-1, ...} for a linear one; empty: all are linear. Nodes are
  // vertices. Edges are straight at rest, with the nodes at their midpoints.
  std::vector<MidNodes> mids = {};
  std::vector<Triangle> sheet = {};    // triangles of sheets, which have no tets
  std::vector<double> thickness = {};  // of each triangle of `sheet` [m]
  // Rest shapes of the triangles of `sheet` in a plane z = 0 [m]; empty: those of `rest`. They may differ at common
  // edges, as at darts.
  std::vector<std::array<Vec3d, 3>> pattern = {};
  std::vector<Segment> rods = {};   // segments of rods, which have neither tets nor triangles
  std::vector<double> radius = {};  // of each segment of `rods` [m]

  int vertex_count() const { return static_cast<int>(rest.size()); }
  int tet_count() const { return static_cast<int>(tets.size()); }
  // Elements are the tets, then the triangles of sheets, then the segments of rods.
  int element_count() const { return first_segment() + static_cast<int>(rods.size()); }
  bool is_tet(int element) const { return element < tet_count(); }
  bool is_triangle(int element) const { return !is_tet(element) && element < first_segment(); }
  const Triangle& triangle(int element) const { return sheet[element - tet_count()]; }
  int first_segment() const { return tet_count() + static_cast<int>(sheet.size()); }  // its element
  const Segment& segment(int element) const { return rods[element - first_segment()]; }
};

struct TriMesh {
  std::vector<Vec3d> vertices;      // [m]
  std::vector<Triangle> triangles;  // counter-clockwise seen from outside

  int vertex_count() const { return static_cast<int>(vertices.size()); }
  int triangle_count() const { return static_cast<int>(triangles.size()); }
};

// Dm = [X1 - X0, X2 - X0, X3 - X0]
inline Mat3d edge_matrix(const TetMesh& mesh, int tet) {
  const auto& [a, b, c, d] = mesh.tets[tet];
  const auto& X = mesh.rest;
  return from_columns(X[b] - X[a], X[c] - X[a], X[d] - X[a]);
}
inline double volume(const TetMesh& mesh, int tet) { return determinant(edge_matrix(mesh, tet)) / 6; }  // signed [m^3]

}  // namespace aspic
