// Prior of p as a penalty R(p); its weight is the strength.
//   R = sum over the fitted quantities of   roughness(z) + mean over the body of (z - guess)^2 / (2 sigma^2)
// for quantities per tet and at handles, with their field z; roughness is H1 or total variation, see field_roughness.h.
// Uniform values and values per region have independent priors: (p_i - guess)^2 / (2 sigma^2). With weight 1, R is
// the negative logarithm of a normal distribution (H1) whose mean over the body has the standard deviation sigma.
// A steep penalty limits fields to a factor of 100 from the guess.
#pragma once
#include <memory>
#include <random>
#include <span>

#include "model/parameter_map.h"

namespace aspic {

enum class Smoothness { none, h1, total_variation };

// Distance of a positive field (log E) from its guess at which the penalty begins: log 100.
inline constexpr double kFarthestOfField = 4.6;

struct RegularizerOptions {
  Smoothness smoothness = Smoothness::h1;  // for quantities that vary from tet to tet, on the fitted scale (log E)
  double prior_sigma = 2;  // standard deviation about the guess on the fitted scale: log E +- 2; infinity: no prior
  // For total variation: changes below 1/sharpness across the body count as smooth, larger ones as edges.
  double sharpness = 10;
};

class Regularizer {
 public:
  virtual ~Regularizer() = default;
  virtual double value(std::span<const double> p) const = 0;
  virtual void add_gradient(std::span<const double> p, double scale, std::span<double> g) const = 0;
  // y += scale R'' v, with total variation's curvature lagged so that it is positive semidefinite.
  virtual void add_hessian_product(std::span<const double> p, std::span<const double> v, double scale,
                                   std::span<double> y) const = 0;
  // z = (R''(p) + shift I)^-1 v: a preconditioner, and the prior covariance. Without prior and shift, a prior of
  // standard deviation 100 makes it invertible.
  virtual void solve(std::span<const double> p, std::span<const double> v, double shift, std::span<double> z) = 0;
  // g += a normal random vector with covariance R''(p): R''^-1 g is a sample of the prior.
  virtual void add_noise(std::span<const double> p, std::mt19937_64& random, std::span<double> g) const = 0;
};

// Throws InvalidInput unless standard deviations and sharpness are positive.
std::unique_ptr<Regularizer> make_regularizer(const TetMesh& mesh, const ParameterMap& map,
                                              const RegularizerOptions& options);

}  // namespace aspic
