// Normal distributions of the parameters, given by products with their precision (inverse covariance) and covariance.
#pragma once
#include <random>
#include <span>
#include <vector>

#include "fit/regularizer.h"

namespace aspic {

class Gaussian {
 public:
  virtual ~Gaussian() = default;
  virtual int size() const = 0;
  virtual void precision(std::span<const double> v, std::span<double> y) = 0;   // y = C^-1 v
  virtual void covariance(std::span<const double> v, std::span<double> z) = 0;  // z = C v
};

// Prior exp(-weight R) with the curvature of R at p. Directions without curvature get a standard deviation of kWidest,
// so that the distribution is proper.
class PriorGaussian : public Gaussian {
 public:
  static constexpr double kWidest = 100;  // standard deviation without information from R: log E +- 100

  // Stores a reference to the regularizer. Requires weight >= 0.
  PriorGaussian(Regularizer& regularizer, double weight, std::span<const double> p);

  int size() const override { return static_cast<int>(p_.size()); }
  void precision(std::span<const double> v, std::span<double> y) override;
  void covariance(std::span<const double> v, std::span<double> z) override;
  void sample(std::mt19937_64& random, std::span<double> x);  // zero mean

 private:
  Regularizer& regularizer_;
  double weight_, floor_;
  std::vector<double> p_;
};

}  // namespace aspic
