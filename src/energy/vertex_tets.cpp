#include "energy/vertex_tets.h"

#include <algorithm>

namespace aspic {

Incidence corners_around_vertices(std::span<const TetBatch> batches, int vertex_count) {
  std::vector<std::pair<int, int>> corners;
  for (size_t i = 0; i < batches.size(); ++i)
    for (int l = 0; l < batches[i].count; ++l)
      for (int v = 0; v < 4; ++v)
        corners.emplace_back(batches[i].vertex[v][l], 4 * (kPackWidth * static_cast<int>(i) + l) + v);
  return {vertex_count, corners};
}

VertexPack gather_corners(std::span<const TetBatch> batches, Positions x, std::span<const int> corners) {
  VertexPack tets;
  Mat3<Pack> Ds, rest_inverse;
  for (int l = 0; l < kPackWidth; ++l) {
    const bool is_padding = l >= static_cast<int>(corners.size());
    const Corner corner(corners[is_padding ? corners.size() - 1 : l]);
    const TetBatch& batch = batches[corner.batch];
    const double* x0 = &x[3 * batch.vertex[0][corner.lane]];
    for (int c = 0; c < 3; ++c) {
      const double* xc = &x[3 * batch.vertex[c + 1][corner.lane]];
      for (int r = 0; r < 3; ++r) Ds(r, c).set(l, xc[r] - x0[r]);
    }
    double D[9];
    for (int i = 0; i < 9; ++i) rest_inverse.a[i].set(l, D[i] = batch.rest_inverse.a[i][corner.lane]);
    for (int c = 0; c < 3; ++c) {
      const double* column = D + 3 * c;
      tets.b[c].set(l, corner.place > 0 ? column[corner.place - 1] : -(column[0] + column[1] + column[2]));
    }
    tets.volume.set(l, is_padding ? 0.0 : batch.volume[corner.lane]);
  }
  tets.F = Ds * rest_inverse;
  return tets;
}

void add_vertex_system(const VertexPack& tets, const Mat3<Pack>& P, const Mat9<Pack>& A, double scale, Vec3d& g,
                       Mat3d& H) {
  const Vec3<Pack>& b = tets.b;
  const Pack weight = Pack(scale) * tets.volume;
  const Vec3<Pack> Pb = P * b;
  for (int r = 0; r < 3; ++r) g[r] += sum(weight * Pb[r]);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) {
      Pack k = 0.0;
      for (int t = 0; t < 3; ++t)
        k += b[t] * (A(r, c + 3 * t) * b[0] + A(r + 3, c + 3 * t) * b[1] + A(r + 6, c + 3 * t) * b[2]);
      H(r, c) += sum(weight * k);
    }
}

}  // namespace aspic
