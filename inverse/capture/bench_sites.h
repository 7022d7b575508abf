// Where a virtual bench pokes, and where it glues its markers.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "capture/surface_projection.h"

namespace aspic {

// `count` points of the surface, each as far as can be from those before, away from held vertices; fewer where the
// surface has no more.
std::vector<ProjectedPoint> marker_sites(const TetMesh& mesh, const SurfaceProjection& surface,
                                         std::span<const int> fixed, int count, uint64_t seed);

// Which vertices of `mesh` lie where all of `truth` around is held.
std::vector<int> held_vertices(const TetMesh& truth, std::span<const int> held, const TetMesh& mesh);

}  // namespace aspic
