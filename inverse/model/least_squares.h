// Residuals r(p) of a model with products of their Jacobian, for fits and their uncertainty.
#pragma once
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace aspic {

// Normal distribution with mean 0 of a nuisance parameter.
struct NuisancePrior {
  double sigma = std::numeric_limits<double>::infinity();  // standard deviation
  double case_sigma = 0;                                   // that of an independent part per case
  double value = 0;                                        // of the parameter in r
};

class LeastSquares {
 public:
  virtual ~LeastSquares() = default;
  virtual int parameter_count() const = 0;
  virtual int residual_count() const = 0;
  // Number of readings with independent errors that the residuals represent: the expectation of |r|^2.
  virtual int reading_count() const { return residual_count(); }
  // Computes r(p). Returns false if it is undefined (no equilibrium found), so that another p must be tried.
  virtual bool evaluate(std::span<const double> p, std::span<double> r) = 0;
  // Linearizes: J = dr/dp at the p of the last successful evaluate(). Returns false if it does not exist.
  virtual bool linearize() = 0;
  virtual void multiply(std::span<const double> dp, std::span<double> dr) = 0;              // dr = J dp
  virtual void multiply_transposed(std::span<const double> w, std::span<double> pbar) = 0;  // pbar = J' w

  // Nuisance directions: changes of r with parameters that are not fitted, such as errors of a pose, the stiffness of a
  // layer, or the factor of an uncertain correction. Residuals along them do not determine p (WithUncertainLayers).
  // Valid as long as J.
  virtual int nuisance_count() const { return 0; }
  virtual NuisancePrior nuisance_prior(int /*k*/) const { return {}; }
  virtual void nuisance(int /*k*/, std::span<double> /*dr*/) {}
  // First residual and count of each part with an independent deviation from the assumption; empty: common to all.
  virtual std::vector<std::pair<int, int>> residuals_by_case() const { return {}; }
};

}  // namespace aspic
