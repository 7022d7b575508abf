// The vertices and tets of one rank.
#pragma once
#include <span>
#include <vector>

#include "dynamics/model.h"

namespace aspic::distributed {

// Each rank owns consecutive vertices of the whole mesh, which is in Hilbert order, and has every tet that touches one
// of them. Numbers of vertices and tets are those of the whole mesh.
struct MeshShare {
  struct Body {
    int first_tet = 0;  // of `tet`
    int counted = 0;    // its first tets, whose energy this rank counts: the smallest vertex is its own
    int halo = 0;       // tets after them, whose energy another rank counts
  };

  int rank = 0;
  std::vector<int> cut;     // first own vertex of each rank, and the number of vertices
  std::vector<int> vertex;  // of each local vertex: first the own ones, then the ghosts, ascending
  std::vector<int> tet;     // of each local tet, body by body
  std::vector<Body> bodies;

  int ranks() const { return static_cast<int>(cut.size()) - 1; }
  int first() const { return cut[rank]; }
  int own() const { return cut[rank + 1] - cut[rank]; }
  bool owns(int whole_vertex) const { return whole_vertex >= cut[rank] && whole_vertex < cut[rank + 1]; }
  int local(int whole_vertex) const;  // -1: this rank does not have the vertex
};

// Requires at least one vertex per rank, linear tets, and that the bodies cover the mesh.
MeshShare make_mesh_share(const TetMesh& whole, std::span<const BodyRange> bodies, int rank, int ranks);

// Returns the local tets and vertices, in their order.
TetMesh local_mesh(const TetMesh& whole, const MeshShare& share);

// Returns the entries of the local vertices, 3 per vertex.
std::vector<double> local_part(std::span<const double> whole, const MeshShare& share);

}  // namespace aspic::distributed
