#include "fit/gaussian.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace aspic {

PriorGaussian::PriorGaussian(Regularizer& regularizer, double weight, std::span<const double> p)
    : regularizer_(regularizer),
      weight_(weight),
      floor_(1 / (kWidest * kWidest * static_cast<double>(std::max<size_t>(p.size(), 1)))),
      p_(p.begin(), p.end()) {
  ASPIC_CHECK(weight >= 0);
}

void PriorGaussian::precision(std::span<const double> v, std::span<double> y) {
  for (size_t i = 0; i < v.size(); ++i) y[i] = floor_ * v[i];
  if (weight_ > 0) regularizer_.add_hessian_product(p_, v, weight_, y);
}

void PriorGaussian::covariance(std::span<const double> v, std::span<double> z) {
  if (weight_ > 0) regularizer_.solve(p_, v, floor_ / weight_, z);
  for (size_t i = 0; i < v.size(); ++i) z[i] = weight_ > 0 ? z[i] / weight_ : v[i] / floor_;
}

void PriorGaussian::sample(std::mt19937_64& random, std::span<double> x) {
  std::vector<double> g(x.size(), 0.0);
  if (weight_ > 0) regularizer_.add_noise(p_, random, g);
  std::normal_distribution<double> normal;
  for (double& value : g) value = std::sqrt(weight_) * value + std::sqrt(floor_) * normal(random);
  covariance(g, x);
}

}  // namespace aspic
