#include "fit/incremental_elasticity.h"

#include "math/polar3.h"

namespace aspic {
namespace {

// Gradients of the four shape functions: the rows of Dm^-1, and minus their sum.
std::array<Vec3d, 4> shape_gradients(const Mat3d& rest_inverse) {
  std::array<Vec3d, 4> b{};
  for (int v = 1; v < 4; ++v)
    for (int r = 0; r < 3; ++r) {
      b[v][r] = rest_inverse(v - 1, r);
      b[0][r] -= b[v][r];
    }
  return b;
}

}  // namespace

IncrementalElasticity::IncrementalElasticity(const TetMesh& mesh, const StrainSpaceModuli& moduli, StressRule rule)
    : mesh_(mesh), moduli_(moduli), rule_(rule) {
  for (int t = 0; t < mesh.tet_count(); ++t)
    tets_.push_back({inverse(edge_matrix(mesh, t)), volume(mesh, t), moduli.at(t, Mat3d{})});
}

Mat3d IncrementalElasticity::stress_at(const State& tet, const Mat3d& strain) const {
  const bool total = rule_ == StressRule::total;
  const Mat3d change = total ? strain : strain - tet.strain;
  return (total ? Mat3d{} : tet.stress) + 2 * tet.moduli.mu * change +
         tet.moduli.lambda * trace(change) * identity3<double>();
}

void IncrementalElasticity::add_gradient(std::span<const double> x, std::span<double> g) const {
  for (size_t t = 0; t < tets_.size(); ++t) {
    const State& tet = tets_[t];
    const Mat3d F = deformation_gradient(mesh_, tet.rest_inverse, static_cast<int>(t), x);
    const Mat3d P = tet.volume * (closest_rotation(F) * stress_at(tet, corotated_strain(F)));
    const std::array<Vec3d, 4> b = shape_gradients(tet.rest_inverse);
    for (int v = 0; v < 4; ++v) {
      const Vec3d force = P * b[v];
      for (int r = 0; r < 3; ++r) g[3 * mesh_.tets[t][v] + r] += force[r];
    }
  }
}

void IncrementalElasticity::add_couplings(Couplings& couplings) const {
  for (const Tet& tet : mesh_.tets)
    for (int v = 0; v < 4; ++v)
      for (int u = 0; u < v; ++u) couplings.push_back({tet[u], tet[v]});
}

// K_uv = volume R (mu (b_u . b_v) I + mu b_v b_u' + lambda b_u b_v') R'
void IncrementalElasticity::add_stiffness(std::span<const double> x, BlockSparse& H) const {
  for (size_t t = 0; t < tets_.size(); ++t) {
    const State& tet = tets_[t];
    const Mat3d R = closest_rotation(deformation_gradient(mesh_, tet.rest_inverse, static_cast<int>(t), x));
    std::array<Vec3d, 4> b = shape_gradients(tet.rest_inverse);
    for (Vec3d& bv : b) bv = R * bv;
    for (int u = 0; u < 4; ++u)
      for (int v = 0; v < 4; ++v) {
        const int row = mesh_.tets[t][u], column = mesh_.tets[t][v];
        if (column > row) continue;
        Mat3d& K = H.block[H.pattern->slot(row, column)];
        const double shear = tet.volume * tet.moduli.mu, lame = tet.volume * tet.moduli.lambda;
        for (int c = 0; c < 3; ++c) {
          for (int r = 0; r < 3; ++r) K(r, c) += shear * b[v][r] * b[u][c] + lame * b[u][r] * b[v][c];
          K(c, c) += shear * dot(b[u], b[v]);
        }
      }
  }
}

void IncrementalElasticity::accept(std::span<const double> x) {
  for (size_t t = 0; t < tets_.size(); ++t) {
    State& tet = tets_[t];
    const Mat3d strain = corotated_strain(deformation_gradient(mesh_, tet.rest_inverse, static_cast<int>(t), x));
    const Mat3d stress = stress_at(tet, strain);
    work_ += tet.volume * 0.5 * inner(stress + tet.stress, strain - tet.strain);
    tet.strain = strain;
    tet.stress = stress;
    tet.moduli = moduli_.at(static_cast<int>(t), strain);
  }
}

}  // namespace aspic
