// Fine surfaces (skins) embedded in coarse tet meshes (cages): each skin vertex is a fixed combination of the nodes of
// one tet.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// The point sum of weight[n] x_n over the first `count` vertices.
struct Carrier {
  int count = 0;                    // 1, 4 or 10: a vertex, a linear or a quadratic tet
  std::array<int, 10> vertex{};     // nodes of the tet
  std::array<double, 10> weight{};  // shape functions, sum to 1; some negative

  static Carrier of_vertex(int v) { return {1, {v}, {1}}; }
  std::span<const int> vertices() const { return std::span(vertex).first(count); }
  int nearest_vertex() const;                       // the vertex with the largest weight
  Vec3d position(std::span<const double> x) const;  // x: 3 per vertex [m]
};

struct Embedding {
  std::vector<Carrier> carriers;  // one per skin vertex
  int outside = 0;                // number of skin vertices outside every tet
};

// Finds the tet of each skin vertex. Vertices outside every tet are extrapolated from the nearest tet, linearly.
Embedding embed(const TetMesh& cage, const TriMesh& skin);

// Computes the skin positions, 3 per skin vertex [m], from the cage positions x, 3 per vertex [m].
void carry(const Embedding& embedding, std::span<const double> x, std::span<double> skin_x);

}  // namespace aspic
