// The vertices and tets of one rank.
#pragma once
#include <span>
#include <vector>

#include "dynamics/model.h"

namespace aspic::distributed {

// Each rank owns consecutive vertices of the whole mesh, which is in Hilbert order, and has every tet that touches one
// of them.
struct MeshShare {
  struct Body {
    int first_tet = 0;  // of the local tets
    int counted = 0;    // its first tets, whose energy this rank counts: the smallest vertex is its own
    int halo = 0;       // tets after them, whose energy another rank counts
  };

  int rank = 0;
  std::vector<int> cut;          // first own vertex of each rank, and the number of vertices
  std::vector<int> vertex;       // of the whole mesh, for each local one: first the own ones, then ghosts, ascending
  std::vector<int> user_vertex;  // user's number of each local vertex
  std::vector<int> user_tet;     // user's number of each local tet, body by body
  std::vector<Body> bodies;      // local tets
  std::vector<BodyRange> of_bodies;  // ranges of the bodies in the whole mesh

  int ranks() const { return static_cast<int>(cut.size()) - 1; }
  int first() const { return cut[rank]; }
  int own() const { return cut[rank + 1] - cut[rank]; }
  int local_vertices() const { return static_cast<int>(vertex.size()); }
  bool owns(int whole_vertex) const { return whole_vertex >= cut[rank] && whole_vertex < cut[rank + 1]; }
  int local(int whole_vertex) const;  // -1: this rank does not have the vertex
};

std::vector<int> equal_cuts(int count, int parts);  // first element of each part, and the count

// Sets `bodies`, `vertex` and `user_tet` of a share, and returns its local tets. `tets`: those of each body that touch
// own vertices, by vertices of the whole mesh, and `numbers`: their numbers of the user, both in the order of the whole
// mesh. Tets that are not counted move to the end of their body.
std::vector<Tet> arrange(const std::vector<std::vector<Tet>>& tets, const std::vector<std::vector<int>>& numbers,
                         MeshShare& share);

}  // namespace aspic::distributed
