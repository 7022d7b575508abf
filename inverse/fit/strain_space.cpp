#include "fit/strain_space.h"

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
constexpr double kLeastPoisson = -0.9, kLargestPoisson = 0.495;

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
            std::fmax(kLeastPoisson, poisson.minCoeff() - 0.05),
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

}  // namespace aspic
