// kPackWidth tets side by side: connectivity and rest shape, one lane per tet. The last batch is padded with copies of
// its first tet with zero volume, so there is no remainder loop.
#pragma once
#include <array>
#include <span>

#include "base/check.h"
#include "energy/energy.h"
#include "math/pack.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct TetBatch {
  static constexpr int W = kPackWidth;
  std::array<std::array<int, W>, 4> vertex;  // ascending within a tet, so that block (u, v) with u > v is stored
  std::array<std::array<int, W>, 10> slot;   // blocks (0,0) (1,0) (1,1) (2,0) ... (3,3)
  std::array<int, W> tet;                    // index in the mesh
  int count = 0;                             // number of lanes without the padding
  Mat3<Pack> rest_inverse;                   // Dm^-1 [1/m]
  Pack volume;                               // [m^3]

  TetBatch() = default;
  TetBatch(const TetMesh& mesh, std::span<const int> tets);  // 1 to kPackWidth tets

  // Returns Ds, the edges from the first vertex to the others.
  Mat3<Pack> edges(Positions x) const {
    std::array<std::array<Pack, 3>, 4> corner;
    for (int v = 0; v < 4; ++v) corner[v] = gather3([&](int l) { return &x[3 * vertex[v][l]]; });
    Mat3<Pack> Ds;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) Ds(r, c) = corner[c + 1][r] - corner[0][r];
    return Ds;
  }
  Mat3<Pack> deformation_gradient(Positions x) const { return edges(x) * rest_inverse; }  // F = Ds Dm^-1

  // Returns the gradients of the four linear shape functions in the rest frame: the rows of Dm^-1, and minus their sum.
  std::array<Vec3<Pack>, 4> shape_gradients() const {
    std::array<Vec3<Pack>, 4> b;
    for (int r = 0; r < 3; ++r) {
      for (int v = 1; v < 4; ++v) b[v][r] = rest_inverse(v - 1, r);
      b[0][r] = -(b[1][r] + b[2][r] + b[3][r]);
    }
    return b;
  }

  unsigned lanes_covered(const Projection& projection) const;  // bit l: lane l is a tet whose Hessian is to be modified

  void scatter_gradient(const Mat3<Pack>& P, Pack weight, std::span<double> g) const;  // g_v += weight P b_v
  void scatter_hessian(const Mat9<Pack>& A, Pack weight, BlockSparse& H) const;        // H_uv += weight b_u' A b_v
  // H_uv += block(u, v), v <= u
  template <class Block>
  void scatter_blocks(const Block& block, BlockSparse& H) const {
#pragma GCC unroll 4
    for (int u = 0; u < 4; ++u)
#pragma GCC unroll 4
      for (int v = 0; v <= u; ++v)
        scatter9(block(u, v), [&](int l) { return H.block[slot[u * (u + 1) / 2 + v][l]].a; });
  }
  // Prefetch the batch itself, and the blocks that it adds to.
  void prefetch() const { aspic::prefetch(this, sizeof *this); }
  void prefetch_blocks(const BlockSparse& H) const {
    for (const auto& slots : slot)
      for (const int s : slots) aspic::prefetch(H.block[s].a + 4, sizeof(double));
  }
  void bind(const BlockPattern& pattern);
};

}  // namespace aspic
