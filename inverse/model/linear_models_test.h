// Least squares and priors whose posterior is known exactly.
#pragma once
#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <vector>

#include "model/least_squares.h"
#include "model/regularizer.h"

namespace aspic::test {

// A view of a vector or span; what it refers to must live.
template <class Range>
auto as_vector(Range&& range) {
  const std::span view(range);
  constexpr bool is_const = std::is_const_v<typename decltype(view)::element_type>;
  using Vector = std::conditional_t<is_const, const Eigen::VectorXd, Eigen::VectorXd>;
  return Eigen::Map<Vector>(view.data(), static_cast<Eigen::Index>(view.size()));
}
inline std::vector<double> as_std(const Eigen::VectorXd& x) { return {x.data(), x.data() + x.size()}; }

inline Eigen::VectorXd normal_vector(int size, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd x(size);
  for (double& value : x) value = normal(random);
  return x;
}

// r = J p - b
class LinearModel : public LeastSquares {
 public:
  Eigen::MatrixXd J;
  Eigen::VectorXd b;
  std::vector<Eigen::VectorXd> nuisances;
  int products = 0, transposed_products = 0;

  int parameter_count() const override { return static_cast<int>(J.cols()); }
  int residual_count() const override { return static_cast<int>(J.rows()); }
  bool evaluate(std::span<const double> p, std::span<double> r) override {
    as_vector(r) = J * as_vector(p) - b;
    return true;
  }
  bool linearize() override { return true; }
  void multiply(std::span<const double> dp, std::span<double> dr) override {
    ++products;
    as_vector(dr) = J * as_vector(dp);
  }
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override {
    ++transposed_products;
    as_vector(pbar) = J.transpose() * as_vector(w);
  }
  int nuisance_count() const override { return static_cast<int>(nuisances.size()); }
  void nuisance(int k, std::span<double> dr) override { as_vector(dr) = nuisances[k]; }
};

// R = |G (p - guess)|^2 / 2
class QuadraticPrior : public Regularizer {
 public:
  Eigen::MatrixXd G, curvature;
  Eigen::VectorXd guess;
  QuadraticPrior(Eigen::MatrixXd root, Eigen::VectorXd mean)
      : G(std::move(root)), curvature(G.transpose() * G), guess(std::move(mean)) {}

  double value(std::span<const double> p) const override { return (G * (as_vector(p) - guess)).squaredNorm() / 2; }
  void add_gradient(std::span<const double> p, double scale, std::span<double> g) const override {
    as_vector(g) += scale * (curvature * (as_vector(p) - guess));
  }
  void add_hessian_product(std::span<const double>, std::span<const double> v, double scale,
                           std::span<double> y) const override {
    as_vector(y) += scale * (curvature * as_vector(v));
  }
  void solve(std::span<const double>, std::span<const double> v, double shift, std::span<double> z) override {
    if (factored_shift_ != shift) {
      const Eigen::Index n = curvature.rows();
      factor_.compute(curvature + shift * Eigen::MatrixXd::Identity(n, n));
      factored_shift_ = shift;
    }
    as_vector(z) = factor_.solve(as_vector(v));
  }
  void add_noise(std::span<const double>, std::mt19937_64& random, std::span<double> g) const override {
    as_vector(g) += G.transpose() * normal_vector(static_cast<int>(G.rows()), random);
  }
  // guess + a sample, for the weight.
  Eigen::VectorXd draw(double weight, std::mt19937_64& random) const {
    const Eigen::VectorXd g = G.transpose() * normal_vector(static_cast<int>(G.rows()), random);
    return guess + curvature.llt().solve(g) / std::sqrt(weight);
  }

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double factored_shift_ = -1;
};

// Differences along a chain of n values, and each about its guess.
inline QuadraticPrior chain_prior(int n, double smooth, double sigma, double guess = 0) {
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(2 * n - 1, n);
  for (int i = 0; i + 1 < n; ++i) G(i, i) = smooth, G(i, i + 1) = -smooth;
  for (int i = 0; i < n; ++i) G(n - 1 + i, i) = 1 / sigma;
  return {G, Eigen::VectorXd::Constant(n, guess)};
}

// m averages over a few neighbors of n values, each with an own weight.
inline LinearModel averages(int n, int m, double strength, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  LinearModel model;
  model.J = Eigen::MatrixXd::Zero(m, n);
  for (int i = 0; i < m; ++i) {
    const int center = static_cast<int>(uniform(random) * n), width = 1 + static_cast<int>(uniform(random) * n / 8);
    const double weight = strength * std::pow(10, -2 * uniform(random));
    for (int j = std::max(0, center - width); j < std::min(n, center + width); ++j)
      model.J(i, j) = weight * (uniform(random) - 0.3);
  }
  model.b = Eigen::VectorXd::Zero(m);
  return model;
}

}  // namespace aspic::test
