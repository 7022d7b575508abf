// A fine surface carried by a coarse tet mesh: each skin vertex is a fixed combination of the corners of one tet.
#pragma once
#include <span>

#include "mesh/tet_mesh.h"

namespace aspic {

struct Embedding {
  std::vector<Tet> vertices;                   // corners of the carrying tet, per skin vertex
  std::vector<std::array<double, 4>> weights;  // barycentric, summing to 1; negative outside the cage
  int outside = 0;                             // skin vertices that no tet contains
};

// Finds the tet of each skin vertex. Vertices outside every tet are extrapolated from the nearest one.
Embedding embed(const TetMesh& cage, const TriMesh& skin);

// Computes the positions of the skin, 3 per skin vertex [m], from those of the cage, 3 per vertex [m].
void carry(const Embedding& embedding, std::span<const double> x, std::span<double> skin_x);

}  // namespace aspic
