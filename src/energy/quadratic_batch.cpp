#include "energy/quadratic_batch.h"

#include <algorithm>
#include <utility>

namespace aspic {
namespace {

static_assert(kPackWidth <= 8, "transposed_ has one bit per lane");

using Vec3Pack = std::array<Pack, 3>;

Pack lesser(Pack a, Pack b) { return -max(-a, -b); }

}  // namespace

template <const NodeTable& table>
QuadraticBatchAt<table>::QuadraticBatchAt(const TetMesh& mesh, std::span<const int> tets) : BatchOf<10>(tets) {
  for (int l = 0; l < W; ++l) {
    set_rest_shape(mesh, l, mesh.tets[tet[l]], kPoints);
    const TetNodes nodes = nodes_of(mesh, tet[l]);
    ASPIC_CHECK(nodes.count == 10);
    for (int n = 0; n < 10; ++n) vertex[n][l] = nodes[n];
  }
}

// Uses positions relative to the first node, so that rounding does not depend on the distance from the origin.
template <const NodeTable& table>
typename QuadraticBatchAt<table>::Points QuadraticBatchAt<table>::edges(Positions x) const {
  std::array<Vec3Pack, 10> d;
  for (int n = 0; n < 10; ++n) d[n] = gather3([&](int l) { return &x[3 * vertex[n][l]]; });
  for (int n = 9; n >= 0; --n)
    for (int r = 0; r < 3; ++r) d[n][r] -= d[0][r];
  Points edges;
  for (int q = 0; q < kPoints; ++q) {
    std::array<Vec3Pack, 4> y = {};
#pragma GCC unroll 10
    for (int n = 1; n < 10; ++n)
      for (int k = 0; k < table[n].count; ++k)
        for (int r = 0; r < 3; ++r) y[table[n].corner[k]][r] += table[n].value[q][k] * d[n][r];
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) edges[q](r, c) = y[c + 1][r] - y[0][r];
  }
  return edges;
}

// F is linear: at corner q it is (F_q - kFar sum) / (kNear - kFar), where the sum contains all four points. det F is
// cubic, and bounded by its Bernstein coefficients: products of three corners. The bound is the result unless it proves
// that det F is positive in the whole tet.
Pack QuadraticTetBatch::least_determinant(const Points& F) {
  const Mat3<Pack> sum = (F[0] + F[1]) + (F[2] + F[3]);
  Points corner;
  Pack least = determinant(F[0]);
  for (int q = 0; q < kPoints; ++q) {
    corner[q] = Pack(1 / (kNear - kFar)) * (F[q] - Pack(kFar) * sum);
    least = lesser(lesser(least, determinant(F[q])), determinant(corner[q]));
  }
  Pack bound = least;
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j) {
      if (i != j) bound = lesser(bound, Pack(1.0 / 3) * inner(cofactor(corner[i]), corner[j]));
      for (int k = 0; k < j && j < i; ++k) {
        const Mat3<Pack> mixed = cofactor(corner[i] + corner[j]) - cofactor(corner[i]) - cofactor(corner[j]);
        bound = lesser(bound, Pack(1.0 / 6) * inner(mixed, corner[k]));
      }
    }
  return where_positive(bound, least, bound);
}

Pack QuadraticCornerBatch::least_determinant(const Points& F) {
  Pack least = determinant(F[0]);
  for (int q = 1; q < kPoints; ++q) least = lesser(least, determinant(F[q]));
  return least;
}

template <const NodeTable& table>
void QuadraticBatchAt<table>::scatter_gradient(const Points& P, Pack weight, std::span<double> g) const {
  std::array<Vec3Pack, 10> force = {};
  for (int q = 0; q < kPoints; ++q) {
    const Mat3<Pack> f = weight * (P[q] * transpose(rest_inverse));  // the forces on the corners y
    std::array<Vec3Pack, 4> corner;
    for (int r = 0; r < 3; ++r) {
      for (int v = 1; v < 4; ++v) corner[v][r] = f(r, v - 1);
      corner[0][r] = -(f(r, 0) + f(r, 1) + f(r, 2));
    }
#pragma GCC unroll 10
    for (int n = 0; n < 10; ++n)
      for (int k = 0; k < table[n].count; ++k)
        for (int r = 0; r < 3; ++r) force[n][r] += table[n].value[q][k] * corner[table[n].corner[k]][r];
  }
  for (int n = 0; n < 10; ++n) scatter3(force[n], [&](int l) { return &g[3 * vertex[n][l]]; });
}

template <const NodeTable& table>
void QuadraticBatchAt<table>::add_point(int q, const CornerBlocks& K, Blocks& sum) {
  for (int n = 0, block = 0; n < 10; ++n) {
    const NodeDerivatives& row = table[n];
    for (int m = 0; m <= n; ++m, ++block) {
      const NodeDerivatives& column = table[m];
      for (int i = 0; i < row.count; ++i)
        for (int j = 0; j < column.count; ++j) {
          const Pack weight = row.value[q][i] * column.value[q][j];
          const std::array<Pack, 9>& of_corners = K[row.corner[i]][column.corner[j]];
          for (int e = 0; e < 9; ++e) sum[block][e] += weight * of_corners[e];
        }
    }
  }
}

template <const NodeTable& table>
void QuadraticBatchAt<table>::scatter(Blocks& sum, BlockSparse& H) const {
  for (int k = 0; k < kBlocks; ++k) {
    std::array<Pack, 9>& K = sum[k];
    if (transposed_[k] != 0) {
      const Pack is_transposed = lanes_from_bits<Pack>(transposed_[k]);
      for (const auto& [a, b] : {std::pair(1, 3), std::pair(2, 6), std::pair(5, 7)}) {
        const Pack before = K[a];
        K[a] = where_positive(is_transposed, K[b], before);
        K[b] = where_positive(is_transposed, before, K[b]);
      }
    }
    scatter9(K, [&](int l) { return H.block[slot[k][l]].a; });
  }
}

template <const NodeTable& table>
void QuadraticBatchAt<table>::scatter_hessian(const std::array<Mat9<Pack>, kPoints>& A, Pack weight,
                                              BlockSparse& H) const {
  scatter_blocks([&](int q) { return TangentBlocks(*this, A[q], weight); }, H);
}

template <const NodeTable& table>
void QuadraticBatchAt<table>::bind(const BlockPattern& pattern) {
  transposed_ = {};
  for (int l = 0; l < W; ++l)
    for (int u = 0, k = 0; u < 10; ++u)
      for (int v = 0; v <= u; ++v, ++k) {
        const auto [low, high] = std::minmax(vertex[u][l], vertex[v][l]);
        const int64_t s = u == v ? pattern.diagonal(high) : pattern.slot(high, low);
        ASPIC_CHECK(s <= INT32_MAX);
        slot[k][l] = static_cast<int>(s);
        if (vertex[u][l] < vertex[v][l]) transposed_[k] = static_cast<uint8_t>(transposed_[k] | 1U << l);
      }
}

template struct QuadraticBatchAt<kQuadratic>;
template struct QuadraticBatchAt<kQuadraticCorners>;

}  // namespace aspic
