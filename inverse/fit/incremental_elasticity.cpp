#include "fit/incremental_elasticity.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/error.h"
#include "math/polar3.h"

namespace aspic {
namespace {

constexpr double kRidge = 1e-3;       // ridge relative to the mean distance between examples, which smooths them
constexpr double kSameStrain = 1e-9;  // closer examples count as equal
constexpr double kWidened = 0.5;      // extension of the range of log E beyond the examples
constexpr double kMinPoisson = -0.9, kLargestPoisson = 0.495;

double distance(const Mat3d& a, const Mat3d& b) { return std::sqrt(squared_norm(a - b)); }

using Eigen::MatrixXd;

// -|e_i - e_j| is positive definite for weights that sum to 0; a ridge separates examples of equal strain.
MatrixXd interpolation_matrix(const std::vector<Mat3d>& strains) {
  const Eigen::Index n = std::ssize(strains);
  MatrixXd A = MatrixXd::Zero(n + 1, n + 1);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) A(i, j) = -distance(strains[i], strains[j]);
  const double mean = -A.topLeftCorner(n, n).mean();
  A.diagonal().head(n).array() += std::fmax(kRidge * mean, kSameStrain);
  A.row(n).head(n).setOnes();
  A.col(n).head(n).setOnes();
  return A;
}

void check(const TetMesh& mesh, const StrainExample& example) {
  const size_t tets = mesh.tets.size();
  if (example.young.size() != tets || example.poisson.size() != tets || example.x.size() != 3 * mesh.rest.size())
    throw InvalidInput("example '" + example.name + "' is not of this mesh: it has " +
                       std::to_string(example.young.size()) + " tets and " + std::to_string(example.x.size() / 3) +
                       " vertices, the mesh " + std::to_string(tets) + " and " + std::to_string(mesh.rest.size()));
  for (size_t t = 0; t < tets; ++t)
    if (!(example.young[t] > 0) || !(example.poisson[t] > -1 && example.poisson[t] < 0.5))
      throw InvalidInput("example '" + example.name + "', tet " + std::to_string(t) +
                         ": young must be positive and poisson between -1 and 0.5");
}

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

Mat3d corotated_strain(const Mat3d& F) {
  const Svd3<double> f = svd3(F);
  Mat3d e{};
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) e(r, c) += (f.s[k] - 1) * f.V(r, k) * f.V(c, k);
  return e;
}

Mat3d deformation_gradient(const TetMesh& mesh, const Mat3d& rest_inverse, int tet, std::span<const double> x) {
  const Tet& v = mesh.tets[tet];
  Mat3d Ds;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) Ds(r, c) = x[3 * v[c + 1] + r] - x[3 * v[0] + r];
  return Ds * rest_inverse;
}

StrainSpaceModuli::StrainSpaceModuli(const TetMesh& mesh, std::span<const StrainExample> examples) {
  if (examples.empty()) throw InvalidInput("there are no examples to interpolate");
  for (const StrainExample& example : examples) check(mesh, example);
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const Mat3d rest_inverse = inverse(edge_matrix(mesh, t));
    const Eigen::Index n = std::ssize(examples);
    std::vector<Mat3d> strains;
    MatrixXd b = MatrixXd::Zero(n + 1, 2);  // columns: log E, nu
    for (Eigen::Index i = 0; i < n; ++i) {
      const StrainExample& example = examples[i];
      strains.push_back(corotated_strain(deformation_gradient(mesh, rest_inverse, t, example.x)));
      b(i, 0) = std::log(example.young[t]), b(i, 1) = example.poisson[t];
    }
    const auto log_young = b.col(0).head(n), poisson = b.col(1).head(n);
    Tet tet{{},
            0,
            0,
            log_young.minCoeff() - kWidened,
            log_young.maxCoeff() + kWidened,
            std::fmax(kMinPoisson, poisson.minCoeff() - 0.05),
            std::fmin(kLargestPoisson, poisson.maxCoeff() + 0.05)};
    const MatrixXd weights = interpolation_matrix(strains).partialPivLu().solve(b);
    for (Eigen::Index i = 0; i < n; ++i) tet.samples.push_back({strains[i], weights(i, 0), weights(i, 1)});
    tet.log_young = weights(n, 0), tet.poisson = weights(n, 1);
    tets_.push_back(std::move(tet));
  }
}

Lame StrainSpaceModuli::at(int tet, const Mat3d& strain) const {
  const Tet& t = tets_[tet];
  double log_young = t.log_young, poisson = t.poisson;
  for (const Sample& sample : t.samples) {
    const double d = -distance(strain, sample.strain);
    log_young += d * sample.log_young_weight, poisson += d * sample.poisson_weight;
  }
  return lame_from_young_poisson(std::exp(std::clamp(log_young, t.least_log_young, t.largest_log_young)),
                                 std::clamp(poisson, t.least_poisson, t.largest_poisson));
}

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
