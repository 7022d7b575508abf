// kPackWidth quadratic tets side by side, as in tet_batch.h. At each quadrature point a quadratic tet is a linear one
// whose corners are combinations of the nodes,
//   y_i = sum_n dN_n/dl_i x_n,   F = sum_i y_i b_i',
// because dN_n/dl_i depends only on the point. Thus all laws use the kernels of linear tets. The four quadrature points
// integrate quadratic functions exactly.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "energy/tet_batch.h"
#include "mesh/tet_nodes.h"

namespace aspic {

// Barycentric coordinates of the quadrature points: kNear at one corner, kFar at the three others.
inline constexpr double kNear = 0.58541019662496845446, kFar = 0.13819660112501051518;
constexpr double point_coordinate(int point, int corner) { return point == corner ? kNear : kFar; }

// The nonzero derivatives dN_n/dl_i of a shape function at the points.
template <size_t points>
struct NodeDerivatives {
  int count = 0;
  std::array<int, 2> corner{};                        // i
  std::array<std::array<double, 2>, points> value{};  // at each point, for each corner i
};

template <size_t points>
using NodeTable = std::array<NodeDerivatives<points>, 10>;

template <size_t points>
using Barycentric = std::array<std::array<double, 4>, points>;

template <size_t points>
constexpr NodeTable<points> quadratic_derivatives(const Barycentric<points>& at) {
  NodeTable<points> nodes;
  for (int n = 0; n < 10; ++n) {
    const int i = n < 4 ? n : kTetEdges[n - 4][0], j = n < 4 ? n : kTetEdges[n - 4][1];
    nodes[n].count = n < 4 ? 1 : 2;
    nodes[n].corner = {i, j};
    for (size_t q = 0; q < points; ++q) nodes[n].value[q] = {4 * at[q][j] - (n < 4 ? 1 : 0), n < 4 ? 0 : 4 * at[q][i]};
  }
  return nodes;
}

constexpr Barycentric<4> quadrature_points() {
  Barycentric<4> points;
  for (int q = 0; q < 4; ++q)
    for (int i = 0; i < 4; ++i) points[q][i] = point_coordinate(q, i);
  return points;
}
constexpr Barycentric<10> node_points() {
  Barycentric<10> points{};
  for (int n = 0; n < 4; ++n) points[n][n] = 1;
  for (int n = 4; n < 10; ++n)
    for (const int corner : kTetEdges[n - 4]) points[n][corner] = 0.5;
  return points;
}
inline constexpr NodeTable<4> kQuadratic = quadratic_derivatives(quadrature_points());
inline constexpr NodeTable<10> kQuadraticNodes = quadratic_derivatives(node_points());

// The tets at the points of a table.
template <const auto& table>
struct QuadraticBatchAt : BatchOf<10> {
  static constexpr int kPoints = static_cast<int>(table[0].value.size());
  using Points = std::array<Mat3<Pack>, kPoints>;
  using Blocks = std::array<std::array<Pack, 9>, kBlocks>;

  QuadraticBatchAt() = default;
  QuadraticBatchAt(const TetMesh& mesh, std::span<const int> tets);

  Points edges(Positions x) const;  // Ds of the corners y at each point
  void scatter_gradient(const Points& P, Pack weight, std::span<double> g) const;
  void scatter_hessian(const std::array<Mat9<Pack>, kPoints>& A, Pack weight, BlockSparse& H) const;
  // Adds the blocks (u, v) of the corners y at each point.
  template <class BlocksAt>
  void scatter_blocks(const BlocksAt& blocks_at, BlockSparse& H) const {
    Blocks sum = {};
    for (int q = 0; q < kPoints; ++q) {
      const auto blocks = blocks_at(q);
      CornerBlocks K;
#pragma GCC unroll 4
      for (int u = 0; u < 4; ++u)
#pragma GCC unroll 4
        for (int v = 0; v <= u; ++v) set(K, u, v, blocks.block(u, v));
      add_point(q, K, sum);
    }
    scatter(sum, H);
  }
  void bind(const BlockPattern& pattern);

 private:
  using CornerBlocks = std::array<std::array<std::array<Pack, 9>, 4>, 4>;
  static void set(CornerBlocks& K, int u, int v, const std::array<Pack, 9>& block) {
    K[u][v] = block;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) K[v][u][c + 3 * r] = block[r + 3 * c];
  }
  static void add_point(int point, const CornerBlocks& K, Blocks& sum);
  void scatter(Blocks& sum, BlockSparse& H) const;

  std::array<uint8_t, kBlocks> transposed_;  // bit l: the matrix stores the transposed block of lane l
};
extern template struct QuadraticBatchAt<kQuadratic>;
extern template struct QuadraticBatchAt<kQuadraticNodes>;

struct QuadraticTetBatch : QuadraticBatchAt<kQuadratic> {
  using QuadraticBatchAt::QuadraticBatchAt;
  static Pack least_determinant(const Points& F);  // in the whole tet; a lower bound if it is inverted
};

// The corners and middles of edges instead of the quadrature points.
struct QuadraticNodeBatch : QuadraticBatchAt<kQuadraticNodes> {
  using QuadraticBatchAt::QuadraticBatchAt;
  static Pack least_determinant(const Points& F);  // at the nodes
};

}  // namespace aspic
