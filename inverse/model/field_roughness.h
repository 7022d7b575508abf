// Variation of a field over the tets, as integrals over the body divided by its volume V. With the body's size L =
// V^(1/3) they are dimensionless and depend neither on its size nor on the mesh:
//   H1               L^2 / (2 V) int |grad z|^2
//   total variation  L / V int (sqrt(|grad z|^2 + eps^2) - eps)
// In a tet, |grad z|^2 = s = 3/4 sum over its four neighbors of ((z_a - z_b) / |X_a - X_b|)^2, X the centroids. This
// two-point flux is exact on average over the directions of the gradient.
#pragma once
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "linalg/scalar_cholesky.h"
#include "mesh/tet_mesh.h"

namespace aspic {

class FieldRoughness {
 public:
  // `sharpness`: infinity selects H1, otherwise total variation with eps = 1 / (sharpness L).
  explicit FieldRoughness(const TetMesh& mesh, double sharpness = std::numeric_limits<double>::infinity());

  bool is_quadratic() const { return eps_ == 0; }
  double value(std::span<const double> z) const;
  void add_gradient(std::span<const double> z, double scale, std::span<double> g) const;
  // y += scale A v, where the gradient is A(z) z. A is the Hessian of H1, and an upper bound of that of total variation
  // (lagged diffusivity [Vogel 1996]).
  void add_product(std::span<const double> z, std::span<const double> v, double scale, std::span<double> y) const;

  // g += a normal random vector with covariance A(z).
  void add_noise(std::span<const double> z, std::mt19937_64& random, std::span<double> g) const;

  // A(z) as a matrix: three entries per pair of neighbors.
  std::vector<MatrixPlace> places() const;
  std::vector<double> entries(std::span<const double> z) const;

  const std::vector<double>& volume_share() const { return share_; }  // fraction of V per tet

 private:
  struct Pair {
    int a, b;
    double inverse_distance;  // [1/L]
  };
  std::vector<double> squared_gradient(std::span<const double> z) const;  // s per tet [1/L^2]
  std::vector<double> conductivity(std::span<const double> z) const;      // weight of (z_a - z_b)^2 per pair

  double eps_ = 0;             // [1/L]; 0: H1
  std::vector<double> share_;  // V_t / V
  std::vector<Pair> pairs_;
};

}  // namespace aspic
