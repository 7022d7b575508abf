// Probability of measurements that were held out of a fit, by Laplace's approximation: with p normal about the fit to
// the others, of covariance C = (J'J + w R'')^-1, the residuals r of the held-out ones are normal with the covariance
// I + J C J'.
#pragma once
#include <span>
#include <vector>

#include "model/least_squares.h"
#include "model/regularizer.h"

namespace aspic {

// What the probability depends on, for few parameters. Matrices are n x n, column by column.
struct PredictiveResiduals {
  double squares = 0;          // |r|^2
  std::vector<double> Jr;      // J'r
  std::vector<double> JJ;      // J'J of the held-out measurements
  std::vector<double> fitted;  // J'J of the others
  std::vector<double> prior;   // w R''
  bool is_valid = false;

  // Logarithm without the terms of the standard deviations, which all laws share. `noise_factor`: of the standard
  // deviations.
  double log_probability(double noise_factor) const;
};

// `p`: fit to `fitted` with the weight of the prior. Invalid if an equilibrium or a derivative does not exist.
PredictiveResiduals predictive_residuals(LeastSquares& fitted, LeastSquares& held_out, Regularizer& prior,
                                         std::span<const double> p);

}  // namespace aspic
