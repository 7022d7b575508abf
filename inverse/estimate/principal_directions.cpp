#include "estimate/principal_directions.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "linalg/dense_eigen.h"

namespace aspic {
namespace {

std::vector<double> volume_parts(const TetMesh& mesh) {
  std::vector<double> part(mesh.tet_count());
  double total = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) total += part[t] = volume(mesh, t);
  for (double& v : part) v /= total;
  return part;
}

// G = diag(part)^1/2 F for all stacked quantities: |G p|^2 is the mean square of the fields of p.
class WeightedFields {
 public:
  WeightedFields(const ParameterMap& map, const TetMesh& mesh) : map_(map), root_(volume_parts(mesh)) {
    for (double& v : root_) v = std::sqrt(v);
  }
  int size() const { return static_cast<int>(root_.size() * map_.fitted_parameters().size()); }
  void multiply(std::span<const double> p, std::span<double> g) const {
    for (size_t u = 0; u < map_.fitted_parameters().size(); ++u) {
      const std::span<double> part = g.subspan(u * root_.size(), root_.size());
      map_.multiply_fitted(static_cast<int>(u), p, part);
      for (size_t t = 0; t < root_.size(); ++t) part[t] *= root_[t];
    }
  }
  void multiply_transposed(std::span<const double> g, std::span<double> p) const {
    std::fill(p.begin(), p.end(), 0.0);
    std::vector<double> part(root_.size());
    for (size_t u = 0; u < map_.fitted_parameters().size(); ++u) {
      for (size_t t = 0; t < root_.size(); ++t) part[t] = root_[t] * g[u * root_.size() + t];
      map_.add_fitted_transposed(static_cast<int>(u), part, p);
    }
  }

 private:
  const ParameterMap& map_;
  std::vector<double> root_;
};

void orthonormalize(Columns& A) {
  Columns Q(A.rows());
  for (int j = 0; j < A.count(); ++j) {
    const std::span<double> a = A[j];
    const double length = norm(a);
    for (int pass = 0; pass < 2; ++pass) add_product(Q, product_transposed(Q, a), -1, a);
    const double rest = norm(a);
    if (!(rest > 1e-10 * length)) continue;
    for (double& x : a) x /= rest;
    Q.push_back(a);
  }
  A = std::move(Q);
}

}  // namespace

double root_mean_square(const ParameterMap& map, const TetMesh& mesh, std::span<const double> p) {
  const WeightedFields G(map, mesh);
  std::vector<double> g(G.size());
  G.multiply(p, g);
  return norm(g);
}

std::vector<PrincipalDirection> principal_directions(PosteriorGaussian& gaussian, const ParameterMap& map,
                                                     const TetMesh& mesh, int count) {
  constexpr int kSpare = 5, kIterations = 8;
  const WeightedFields G(map, mesh);
  const int rows = G.size();
  Columns X(rows, std::min({count + kSpare, rows, gaussian.size()}));
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int j = 0; j < X.count(); ++j)
    for (double& x : X[j]) x = normal(random);

  // Subspace iteration with G C G'.
  std::vector<double> a(gaussian.size());
  DenseEigen e;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    orthonormalize(X);
    Columns Y(rows, X.count());
    std::vector<double> z(gaussian.size());
    for (int j = 0; j < X.count(); ++j) {
      G.multiply_transposed(X[j], a);
      gaussian.covariance(a, z);
      G.multiply(z, Y[j]);
    }
    e = dense_eigen(X.count(), product_transposed(X, Y));
    X = product(iteration + 1 < kIterations ? Y : X, e.vectors, X.count());
  }

  std::vector<PrincipalDirection> directions;
  std::vector<double> z(gaussian.size());
  for (int j = 0; j < std::min(count, X.count()); ++j) {
    G.multiply_transposed(X[j], a);
    gaussian.prior().covariance(a, z);
    PrincipalDirection d{.prior = dot(a, z), .p = std::vector<double>(gaussian.size())};
    gaussian.covariance(a, d.p);
    d.posterior = dot(a, d.p);
    if (d.posterior > 0) directions.push_back(std::move(d));
  }
  return directions;
}

}  // namespace aspic
