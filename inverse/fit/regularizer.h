// The prior of p as a penalty R(p); its weight is the strength.
//   R = sum over the unknown quantities of   roughness(z) + mean over the body of (z - guess)^2 / (2 deviation^2)
// for quantities per tet and at handles, with z the field that they make; roughness is H1 or total variation, see
// field_roughness.h. Single values and values per region are believed each for itself: (p_i - guess)^2 / (2
// deviation^2). Of weight 1, R is minus the logarithm of a normal distribution (H1), whose mean over the body has the
// standard deviation `deviation`. A field is held back steeply beyond a factor of 100 from its guess.
#pragma once
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "fit/parameter_map.h"

namespace aspic {

enum class Smoothness { none, h1, total_variation };

// Distance of a positive field (log E) from its guess beyond which it is held back: a factor of 100.
inline constexpr double kFarthestOfField = 4.6;

struct RegularizerOptions {
  Smoothness smoothness = Smoothness::h1;  // of quantities that differ from tet to tet, over what is fitted (log E)
  double prior_deviation = 2;              // of what is fitted about its guess: log E +- 2; infinity: no prior
  // Of total variation: a change by less than 1/sharpness across the body counts as smooth, a greater one as an edge.
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
  // z = (R''(p) + shift I)^-1 v: a preconditioner, and the prior covariance. Where there is neither prior nor shift, a
  // prior of deviation 100 takes its place, so that there is an inverse.
  virtual void solve(std::span<const double> p, std::span<const double> v, double shift, std::span<double> z) = 0;
  // g += a normal random vector of covariance R''(p): R''^-1 g is a sample of the prior.
  virtual void add_noise(std::span<const double> p, std::mt19937_64& random, std::span<double> g) const = 0;
};

// Throws InvalidInput for deviations and sharpnesses that are not positive.
std::unique_ptr<Regularizer> make_regularizer(const TetMesh& mesh, const ParameterMap& map,
                                              const RegularizerOptions& options);

}  // namespace aspic
