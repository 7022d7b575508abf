#include "energy/tet_batch.h"

#include <algorithm>
#include <cmath>

namespace aspic {

TetLanes::TetLanes(std::span<const int> tets) : count(static_cast<int>(tets.size())) {
  ASPIC_CHECK(count >= 1 && count <= W);
  for (int l = 0; l < W; ++l) tet[l] = tets[l < count ? l : 0];
}

void TetLanes::set_rest_shape(const TetMesh& mesh, int lane, const Tet& corners, int points) {
  const auto& X = mesh.rest;
  const Mat3d Dm =
      from_columns(X[corners[1]] - X[corners[0]], X[corners[2]] - X[corners[0]], X[corners[3]] - X[corners[0]]);
  const Mat3d Dm_inverse = inverse(Dm);
  for (int i = 0; i < 9; ++i) rest_inverse.a[i].set(lane, Dm_inverse.a[i]);
  volume.set(lane, lane < count ? std::abs(determinant(Dm)) / (6 * points) : 0.0);
}

// Ab[v](i, c) = sum_d A(i, c + 3 d) b_v[d]; the blocks of vertex 0 follow from sum_v b_v = 0.
TangentBlocks::TangentBlocks(const TetLanes& tets, const Mat9<Pack>& A, Pack weight) : b(tets.shape_gradients()) {
  for (int v = 1; v < 4; ++v)
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < 9; ++i)
        Ab[v][i + 9 * c] = weight * (A(i, c) * b[v][0] + A(i, c + 3) * b[v][1] + A(i, c + 6) * b[v][2]);
  for (int k = 0; k < 27; ++k) Ab[0][k] = -(Ab[1][k] + Ab[2][k] + Ab[3][k]);
}

TetBatch::TetBatch(const TetMesh& mesh, std::span<const int> tets) : BatchOf<4>(tets) {
  for (int l = 0; l < W; ++l) {
    Tet corners = mesh.tets[tet[l]];
    std::sort(corners.begin(), corners.end());
    set_rest_shape(mesh, l, corners, kPoints);
    for (int v = 0; v < 4; ++v) vertex[v][l] = corners[v];
  }
}

void TetBatch::bind(const BlockPattern& pattern) {
  for (int l = 0; l < W; ++l)
    for (int u = 0, k = 0; u < 4; ++u)
      for (int v = 0; v <= u; ++v, ++k) {
        const int64_t s = u == v ? pattern.diagonal(vertex[u][l]) : pattern.slot(vertex[u][l], vertex[v][l]);
        ASPIC_CHECK(s <= INT32_MAX);
        slot[k][l] = static_cast<int>(s);
      }
}

void TetBatch::scatter_gradient(const Points& P, Pack weight, std::span<double> g) const {
  const Mat3<Pack> f = weight * (P * transpose(rest_inverse));  // the sum of all four forces vanishes
  std::array<Pack, 3> first;
  for (int r = 0; r < 3; ++r) first[r] = -(f(r, 0) + f(r, 1) + f(r, 2));
  scatter3(first, [&](int l) { return &g[3 * vertex[0][l]]; });
  for (int v = 1; v < 4; ++v)
    scatter3({f(0, v - 1), f(1, v - 1), f(2, v - 1)}, [&](int l) { return &g[3 * vertex[v][l]]; });
}

void TetBatch::scatter_hessian(const Mat9<Pack>& A, Pack weight, BlockSparse& H) const {
  const TangentBlocks blocks(*this, A, weight);
  scatter_blocks([&](int u, int v) { return blocks.block(u, v); }, H);
}

}  // namespace aspic
