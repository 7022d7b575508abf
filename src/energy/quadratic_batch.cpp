#include "energy/quadratic_batch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aspic {
namespace {

static_assert(kPackWidth <= 8, "transposed_ has one bit per lane");

using Vec3Pack = std::array<Pack, 3>;

Pack lesser(Pack a, Pack b) { return -max(-a, -b); }

}  // namespace

template <const auto& table>
QuadraticBatchAt<table>::QuadraticBatchAt(const TetMesh& mesh, std::span<const int> tets) : BatchOf<10>(tets) {
  for (int l = 0; l < W; ++l) {
    set_rest_shape(mesh, l, mesh.tets[tet[l]], kPoints);
    const TetNodes nodes = nodes_of(mesh, tet[l]);
    ASPIC_CHECK(nodes.count == 10);
    for (int n = 0; n < 10; ++n) vertex[n][l] = nodes[n];
  }
}

// Uses positions relative to the first node, so that rounding does not depend on the distance from the origin.
template <const auto& table>
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

namespace {

using Corners = std::array<Mat3d, 4>;  // F at the corners of a tet, within which F is linear

// Returns the least Bernstein coefficient of the cubic det F, a lower bound: each is a product of three corners.
double least_coefficient(const Corners& F) {
  double least = INFINITY;
  for (int i = 0; i < 4; ++i) {
    const Mat3d of_i = cofactor(F[i]);
    for (int j = 0; j < 4; ++j) {
      least = std::min(least, inner(of_i, F[j]) / 3);
      for (int k = 0; k < j && j < i; ++k)
        least = std::min(least, inner(cofactor(F[i] + F[j]) - of_i - cofactor(F[j]), F[k]) / 6);
    }
  }
  return least;
}

// Returns the least determinant at the corners if det F is positive within the tet, else a lower bound of det F. Halves
// the tet across its edges in turn while neither is certain.
double least_within(const Corners& F, int halvings) {
  double least = INFINITY;
  for (const Mat3d& F_i : F) least = std::min(least, determinant(F_i));
  const double bound = least_coefficient(F);
  if (bound > 0) return least;
  if (least <= 0 || halvings == 0) return bound;
  const auto& [a, b] = kTetEdges[halvings % 6];
  Corners first = F, second = F;
  first[b] = second[a] = 0.5 * (F[a] + F[b]);
  return std::min(least_within(first, halvings - 1), least_within(second, halvings - 1));
}

}  // namespace

// F is linear: at corner q it is (F_q - kFar sum) / (kNear - kFar), where the sum contains all four points.
Pack QuadraticTetBatch::least_determinant(const Points& F) {
  constexpr int kHalvings = 12;
  const Mat3<Pack> sum = (F[0] + F[1]) + (F[2] + F[3]);
  Points corner;
  for (int q = 0; q < kPoints; ++q) corner[q] = Pack(1 / (kNear - kFar)) * (F[q] - Pack(kFar) * sum);
  Pack least;
  for (int l = 0; l < kPackWidth; ++l) {
    Corners F_l;
    for (int q = 0; q < kPoints; ++q)
      for (int e = 0; e < 9; ++e) F_l[q].a[e] = corner[q].a[e][l];
    least.set(l, least_within(F_l, kHalvings));
  }
  return least;
}

Pack QuadraticNodeBatch::least_determinant(const Points& F) {
  Pack least = determinant(F[0]);
  for (int q = 1; q < kPoints; ++q) least = lesser(least, determinant(F[q]));
  return least;
}

template <const auto& table>
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

template <const auto& table>
void QuadraticBatchAt<table>::add_point(int q, const CornerBlocks& K, Blocks& sum) {
  for (int n = 0, block = 0; n < 10; ++n) {
    const auto& row = table[n];
    for (int m = 0; m <= n; ++m, ++block) {
      const auto& column = table[m];
      for (int i = 0; i < row.count; ++i)
        for (int j = 0; j < column.count; ++j) {
          const Pack weight = row.value[q][i] * column.value[q][j];
          const std::array<Pack, 9>& of_corners = K[row.corner[i]][column.corner[j]];
          for (int e = 0; e < 9; ++e) sum[block][e] += weight * of_corners[e];
        }
    }
  }
}

template <const auto& table>
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

template <const auto& table>
void QuadraticBatchAt<table>::scatter_hessian(const std::array<Mat9<Pack>, kPoints>& A, Pack weight,
                                              BlockSparse& H) const {
  scatter_blocks([&](int q) { return TangentBlocks(*this, A[q], weight); }, H);
}

template <const auto& table>
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
template struct QuadraticBatchAt<kQuadraticNodes>;

}  // namespace aspic
