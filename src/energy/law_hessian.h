// Hessian of tets with the energy density psi(I1, J), block by block, without the intermediate 9x9 matrix:
//   K_uv = volume (2 psi_I (b_u . b_v) Id + f_u y_v' + g_u z_v' - psi_J [q_uv]x)
//   f_u = F b_u,  y_v = 4 psi_II f_v + 2 psi_IJ g_v,  z_v = psi_JJ g_v + 2 psi_IJ f_v
//   g_u = cof(F) b_u = dJ/dx_u,  q_uv = F (b_u x b_v),  [q]x is the matrix of a -> q x a
// Because J = det(Ds) D with D = det(Dm^-1), g and q depend only on the edges d_v = x_v - x_0:
//   g_1 = D d_2 x d_3,  q_23 = D d_1  and cyclic permutations. The sums over all four vertices vanish.
#pragma once
#include "energy/tet_batch.h"
#include "material/from_invariants.h"

namespace aspic {

using Corners = std::array<Vec3<Pack>, 4>;  // one vector per vertex of a tet

// Quantities that all blocks of a batch share.
template <class Derivatives>
struct LawBlocks {
  static constexpr bool kIsLinearInI1 = std::is_same_v<Derivatives, LawDerivativesLinearInI1<Pack>>;
  Pack identity;  // 2 psi_I; like all members below multiplied by the weight
  Corners b, g, z;
  Corners f, y;        // only for densities that are nonlinear in I1
  Mat3<Pack> tension;  // psi_J D d_v in column v - 1

  LawBlocks(const TetLanes& tets, const Mat3<Pack>& Ds, const Derivatives& d, Pack weight)
      : identity(Pack(2.0) * weight * d.dI), b(tets.shape_gradients()) {
    const Pack D = determinant(tets.rest_inverse);
    g = with_sum_zero(D * cofactor(Ds));
    tension = (weight * d.dJ * D) * Ds;
    for (int v = 0; v < 4; ++v) z[v] = (weight * d.dJJ) * g[v];
    if constexpr (!kIsLinearInI1) {
      const Mat3<Pack> F = Ds * tets.rest_inverse;
      const Pack twice_dIJ = Pack(2.0) * weight * d.dIJ;
      for (int v = 0; v < 4; ++v) {
        f[v] = F * b[v];
        y[v] = (Pack(4.0) * weight * d.dII) * f[v] + twice_dIJ * g[v];
        z[v] = z[v] + twice_dIJ * f[v];
      }
    }
  }

  std::array<Pack, 9> block(int u, int v) const {
    const Pack s = identity * dot(b[u], b[v]);
    const Vec3<Pack> q = tension_between(u, v);
    std::array<Pack, 9> K = {s, -q[2], q[1], q[2], s, -q[0], -q[1], q[0], s};
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) {
        K[r + 3 * c] += g[u][r] * z[v][c];
        if constexpr (!kIsLinearInI1) K[r + 3 * c] += f[u][r] * y[v][c];
      }
    return K;
  }

 private:
  static Corners with_sum_zero(const Mat3<Pack>& A) {
    Corners x;
    for (int r = 0; r < 3; ++r) {
      for (int v = 1; v < 4; ++v) x[v][r] = A(r, v - 1);
      x[0][r] = -(x[1][r] + x[2][r] + x[3][r]);
    }
    return x;
  }

  // psi_J q_uv
  Vec3<Pack> tension_between(int u, int v) const {
    const auto edge = [this](int k) { return Vec3<Pack>{{tension(0, k - 1), tension(1, k - 1), tension(2, k - 1)}}; };
    if (u == v) return {{0.0, 0.0, 0.0}};
    const int next = u % 3 + 1, other = next % 3 + 1;
    if (v == 0) return edge(next) - edge(other);
    return v == next ? edge(other) : Pack(-1.0) * edge(next);
  }
};

}  // namespace aspic
