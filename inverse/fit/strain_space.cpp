#include "fit/strain_space.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/polar3.h"

namespace aspic {
namespace {

constexpr double kRidge = 1e-3;       // ridge relative to the mean distance between examples, which smooths them
constexpr double kSameStrain = 1e-9;  // closer examples count as equal
constexpr double kWidened = 0.5;      // extension of the range of log E beyond the examples
constexpr double kLeastPoisson = -0.9, kLargestPoisson = 0.495;

double distance(const Mat3d& a, const Mat3d& b) { return std::sqrt(squared_norm(a - b)); }

// Small square system with two right-hand sides, solved by elimination with partial pivoting.
struct StrainColumns {
  double log_young, poisson;
};
void solve(std::vector<double>& A, std::vector<StrainColumns>& b) {
  const size_t n = b.size();
  for (size_t k = 0; k < n; ++k) {
    size_t pivot = k;
    for (size_t i = k + 1; i < n; ++i)
      if (std::abs(A[i * n + k]) > std::abs(A[pivot * n + k])) pivot = i;
    for (size_t j = 0; j < n; ++j) std::swap(A[k * n + j], A[pivot * n + j]);
    std::swap(b[k], b[pivot]);
    for (size_t i = k + 1; i < n; ++i) {
      const double factor = A[i * n + k] / A[k * n + k];
      for (size_t j = k; j < n; ++j) A[i * n + j] -= factor * A[k * n + j];
      b[i].log_young -= factor * b[k].log_young, b[i].poisson -= factor * b[k].poisson;
    }
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t j = i + 1; j < n; ++j) {
      b[i].log_young -= A[i * n + j] * b[j].log_young;
      b[i].poisson -= A[i * n + j] * b[j].poisson;
    }
    b[i].log_young /= A[i * n + i], b[i].poisson /= A[i * n + i];
  }
}

// -|e_i - e_j| is positive definite for weights that sum to 0; a ridge separates examples of equal strain.
std::vector<double> interpolation_matrix(const std::vector<Mat3d>& strains) {
  const size_t n = strains.size(), size = n + 1;
  std::vector<double> A(size * size, 0.0);
  double sum = 0;
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < n; ++j) sum += -(A[i * size + j] = -distance(strains[i], strains[j]));
  const double mean = sum / static_cast<double>(n * n);
  for (size_t i = 0; i < n; ++i) {
    A[i * size + i] += std::fmax(kRidge * mean, kSameStrain);
    A[i * size + n] = A[n * size + i] = 1;
  }
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
    std::vector<Mat3d> strains;
    std::vector<StrainColumns> b;
    for (const StrainExample& example : examples) {
      strains.push_back(corotated_strain(deformation_gradient(mesh, rest_inverse, t, example.x)));
      b.push_back({std::log(example.young[t]), example.poisson[t]});
    }
    const auto by_young = [](const StrainColumns& p, const StrainColumns& q) { return p.log_young < q.log_young; };
    const auto by_poisson = [](const StrainColumns& p, const StrainColumns& q) { return p.poisson < q.poisson; };
    const auto [soft, stiff] = std::minmax_element(b.begin(), b.end(), by_young);
    const auto [least, largest] = std::minmax_element(b.begin(), b.end(), by_poisson);
    Tet tet{{},
            0,
            0,
            soft->log_young - kWidened,
            stiff->log_young + kWidened,
            std::fmax(kLeastPoisson, least->poisson - 0.05),
            std::fmin(kLargestPoisson, largest->poisson + 0.05)};
    b.push_back({0, 0});
    std::vector<double> A = interpolation_matrix(strains);
    solve(A, b);
    for (size_t i = 0; i < strains.size(); ++i) tet.samples.push_back({strains[i], b[i].log_young, b[i].poisson});
    tet.log_young = b.back().log_young, tet.poisson = b.back().poisson;
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
