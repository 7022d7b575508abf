// Sites of indentations and markers of a virtual bench.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "data/surface_projection.h"

namespace aspic {

// Returns `count` points of the surface, each as far as possible from the previous ones and away from held vertices;
// fewer if the surface has no more.
std::vector<ProjectedPoint> marker_sites(const TetMesh& mesh, const SurfaceProjection& surface,
                                         std::span<const int> fixed, int count, uint64_t seed);

// Vertices of `mesh` at places where all surrounding vertices of `truth` are held.
std::vector<int> held_vertices(const TetMesh& truth, std::span<const int> held, const TetMesh& mesh);

}  // namespace aspic
