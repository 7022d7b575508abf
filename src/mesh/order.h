// Space-filling orders that keep spatial neighbors close in memory.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

// Returns the indices of the points along the Morton (Z-order) curve of their bounding cube. Points in the same cell of
// its 2^21-fold grid keep their order. Points that are not finite come first.
std::vector<int> morton_order(std::span<const Vec3d> points);
// The same along the Hilbert curve, whose consecutive cells are always adjacent.
std::vector<int> hilbert_order(std::span<const Vec3d> points);

// Returns the index along the Hilbert curve of a point in a cube. Points of equal index keep the user's order.
std::uint64_t hilbert_index(const Vec3d& point, const Vec3d& lower, double size);

std::vector<Vec3d> centroids(const TetMesh& mesh);                           // centroids of the tets at rest [m]
std::vector<Vec3d> centroids(const TetMesh& mesh, int first, size_t count);  // the same for a range of tets

}  // namespace aspic
