// Fine surfaces (skins) embedded in coarse tet meshes (cages): each skin vertex is a fixed combination of the corners
// of one tet, or of one of the linear parts of a quadratic tet.
#pragma once
#include <span>

#include "mesh/tet_mesh.h"

namespace aspic {

struct Embedding {
  std::vector<Tet> vertices;                   // corners of the tet that carries each skin vertex
  std::vector<std::array<double, 4>> weights;  // barycentric, sum to 1; negative outside the cage
  int outside = 0;                             // number of skin vertices outside every tet
};

// Finds the tet of each skin vertex. Vertices outside every tet are extrapolated from the nearest tet.
Embedding embed(const TetMesh& cage, const TriMesh& skin);

// Computes the skin positions, 3 per skin vertex [m], from the cage positions x, 3 per vertex [m].
void carry(const Embedding& embedding, std::span<const double> x, std::span<double> skin_x);

}  // namespace aspic
