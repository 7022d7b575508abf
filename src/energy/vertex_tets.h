// The tets around a vertex, kPackWidth of them side by side, gathered from the batches in which they are stored.
#pragma once
#include <span>
#include <vector>

#include "energy/incidence.h"
#include "energy/tet_batch.h"
#include "material/material.h"

namespace aspic {

// A corner of a tet as a number: which batch, which lane, which of its four vertices.
struct Corner {
  int batch, lane, place;
  explicit Corner(int number) : batch(number / (4 * kPackWidth)), lane(number / 4 % kPackWidth), place(number % 4) {}
};
Incidence corners_around_vertices(std::span<const TetBatch> batches, int vertex_count);

struct VertexPack {
  Mat3<Pack> F;
  Vec3<Pack> b;  // gradient of the vertex's shape function in the rest frame
  Pack volume;   // 0 in lanes beyond the last corner, which repeat it
};
// 1 to kPackWidth corners.
VertexPack gather_corners(std::span<const TetBatch> batches, Positions x, std::span<const int> corners);

// The parameters of the same tets.
template <class M>
typename M::template Params<Pack> gather_params(std::span<const typename M::template Params<Pack>> batches,
                                                std::span<const int> corners) {
  ParameterArray<M, Pack> to;
  for (int l = 0; l < kPackWidth; ++l) {
    const Corner corner(corners[std::min<size_t>(l, corners.size() - 1)]);
    const Pack* from = reinterpret_cast<const Pack*>(&batches[corner.batch]);  // Params is an array of Packs
    for (size_t k = 0; k < to.size(); ++k) to[k].set(l, from[k][corner.lane]);
  }
  return std::bit_cast<typename M::template Params<Pack>>(to);
}

// g += scale volume P b, H += scale volume b' A b, summed over the lanes in order. P = dpsi/dF, A = dP/dF.
void add_vertex_system(const VertexPack& tets, const Mat3<Pack>& P, const Mat9<Pack>& A, double scale, Vec3d& g,
                       Mat3d& H);

}  // namespace aspic
