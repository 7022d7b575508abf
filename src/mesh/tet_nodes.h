// Nodes of linear and quadratic tets, of triangles of sheets and of segments of rods. Code that handles all loops over
// nodes_of().
#pragma once
#include <array>
#include <span>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

inline constexpr int kTetEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};  // as in VTK files

// The nodes of an element: two ends of a segment, three corners of a triangle, or four of a tet, then the mid-edge
// nodes of a quadratic tet.
struct TetNodes {
  std::array<int, 10> node;
  int count;

  int operator[](int i) const { return node[i]; }
  const int* begin() const { return node.data(); }
  const int* end() const { return node.data() + count; }
};

inline bool is_quadratic(const TetMesh& mesh, int tet) { return !mesh.mids.empty() && mesh.mids[tet][0] >= 0; }
TetNodes nodes_of(const TetMesh& mesh, int element);

// Returns the shape functions N_n of a quadratic tet at barycentric coordinates l, and dN_n/dl_i.
std::array<double, 10> quadratic_shapes(const std::array<double, 4>& l);
double quadratic_derivative(int n, int i, const std::array<double, 4>& l);

// Makes all tets of a linear mesh quadratic. The new nodes follow the vertices, in the order of the tets.
TetMesh raise_order(TetMesh mesh);

// Makes all tets linear and removes the vertices that are only mid-edge nodes.
TetMesh lower_order(TetMesh mesh);

// Moves the mid-edge nodes to the midpoints of their edges. `positions`: one per vertex.
void straighten_edges(const TetMesh& mesh, std::vector<Vec3d>& positions);

// Corners of the linear tet that has the deformation gradient of the tet's centroid; those of a linear tet itself. x: 3
// entries per vertex.
std::array<Vec3d, 4> center_corners(const TetMesh& mesh, int tet, std::span<const double> x);

// A mesh with the same vertices, sheets and rods, of linear tets: the linear tets themselves, and eight parts of each
// quadratic tet.
struct LinearParts {
  TetMesh mesh;
  std::vector<int> tet;  // tet that contains each part
};
LinearParts linear_parts(const TetMesh& mesh);

}  // namespace aspic
