// kPackWidth linear tets side by side: connectivity and rest shape, one lane per tet. The last batch is padded with
// copies of its first tet with zero volume, so there is no remainder loop.
#pragma once
#include <array>
#include <span>

#include "base/check.h"
#include "energy/energy.h"
#include "math/pack.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// Rest shapes of the tets of a batch.
struct TetLanes {
  static constexpr int W = kPackWidth;
  std::array<int, W> tet;   // index in the mesh
  int count = 0;            // number of lanes without the padding
  Mat3<Pack> rest_inverse;  // Dm^-1 [1/m]
  Pack volume;              // per quadrature point [m^3]

  TetLanes() = default;
  TetLanes(std::span<const int> tets);  // 1 to kPackWidth tets
  void set_rest_shape(const TetMesh& mesh, int lane, const Tet& corners, int points);

  // Returns the gradients of the four linear shape functions in the rest frame: the rows of Dm^-1, and minus their sum.
  std::array<Vec3<Pack>, 4> shape_gradients() const {
    std::array<Vec3<Pack>, 4> b;
    for (int r = 0; r < 3; ++r) {
      for (int v = 1; v < 4; ++v) b[v][r] = rest_inverse(v - 1, r);
      b[0][r] = -(b[1][r] + b[2][r] + b[3][r]);
    }
    return b;
  }
};

// Nodes of the tets of a batch, and the slots of their blocks.
template <int kNodes>
struct BatchOf : TetLanes {
  static constexpr int kBlocks = kNodes * (kNodes + 1) / 2;
  std::array<std::array<int, W>, kNodes> vertex;
  std::array<std::array<int, W>, kBlocks> slot;  // blocks (0,0) (1,0) (1,1) (2,0) ...

  using TetLanes::TetLanes;

  // Bit l: lane l is a tet whose Hessian is to be modified.
  unsigned lanes_covered(const Projection& projection) const {
    if (projection.vertices.empty()) return (1U << count) - 1;
    unsigned lanes = 0;
    for (int l = 0; l < count; ++l)
      for (const auto& node : vertex) lanes |= static_cast<unsigned>(projection.covers(node[l])) << l;
    return lanes;
  }
  // Prefetch the batch itself, and the blocks that it adds to.
  void prefetch() const { aspic::prefetch(this, sizeof *this); }
  void prefetch_blocks(const BlockSparse& H) const {
    for (const auto& slots : slot)
      for (const int s : slots) aspic::prefetch(H.block[s].a + 4, sizeof(double));
  }
};

// Blocks of the Hessian for A = dP/dF: K_uv = weight b_u' A b_v.
struct TangentBlocks {
  std::array<Vec3<Pack>, 4> b;
  std::array<std::array<Pack, 27>, 4> Ab;

  TangentBlocks(const TetLanes& tets, const Mat9<Pack>& A, Pack weight);
  std::array<Pack, 9> block(int u, int v) const {
    std::array<Pack, 9> K;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        K[r + 3 * c] = b[u][0] * Ab[v][r + 9 * c] + b[u][1] * Ab[v][r + 3 + 9 * c] + b[u][2] * Ab[v][r + 6 + 9 * c];
    return K;
  }
};

struct TetBatch : BatchOf<4> {  // vertices ascend within a tet, so that block (u, v) with u > v is stored
  static constexpr int kPoints = 1;
  using Points = Mat3<Pack>;  // one matrix per quadrature point

  TetBatch() = default;
  TetBatch(const TetMesh& mesh, std::span<const int> tets);

  // Returns Ds, the edges from the first vertex to the others. F = Ds Dm^-1.
  Points edges(Positions x) const {
    std::array<std::array<Pack, 3>, 4> corner;
    for (int v = 0; v < 4; ++v) corner[v] = gather3([&](int l) { return &x[3 * vertex[v][l]]; });
    Mat3<Pack> Ds;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) Ds(r, c) = corner[c + 1][r] - corner[0][r];
    return Ds;
  }
  static Pack least_determinant(const Points& F) { return determinant(F); }

  void scatter_gradient(const Points& P, Pack weight, std::span<double> g) const;  // g_v += weight P b_v
  void scatter_hessian(const Mat9<Pack>& A, Pack weight, BlockSparse& H) const;
  template <class Block>  // H_uv += block(u, v), v <= u
  void scatter_blocks(const Block& block, BlockSparse& H) const {
#pragma GCC unroll 4
    for (int u = 0; u < 4; ++u)
#pragma GCC unroll 4
      for (int v = 0; v <= u; ++v)
        scatter9(block(u, v), [&](int l) { return H.block[slot[u * (u + 1) / 2 + v][l]].a; });
  }
  void bind(const BlockPattern& pattern);
};

}  // namespace aspic
