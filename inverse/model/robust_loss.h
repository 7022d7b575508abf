// A loss for readings with outliers: the sum of rho(|r|^2) / 2 over the readings, r their errors in standard
// deviations. It is quadratic up to |r|^2 = 3, the mean of a normal vector, and has the tails of Student's t
// distribution beyond:
//   rho(s) = s for s <= 3,   3 + (nu + 3) log((nu + s) / (nu + 3)) otherwise,   nu = 4
// With weights rho'(s) it is minimized by iteratively reweighted least squares: each
// such step decreases it, and at a fixed point its gradient is 0. Weights are at most 1, so intervals are never
// narrower.
#pragma once
#include <span>
#include <vector>

#include "model/misfit.h"

namespace aspic {

double robust_loss(double squared);    // rho
double robust_weight(double squared);  // rho'
bool is_outlier(double weight);        // error of more than 5 standard deviations, as the length of a vector

struct CaseWeights {
  std::vector<double> positions;
  double force = 1, torque = 1;
};

// Divides standard deviations by the roots of the weights, and marks outliers among the positions.
Corrected weighted(Corrected experiment, std::span<const CaseWeights> weights);
// Weights of the readings of the fitted cases, which have the residuals r with the present weights.
std::vector<CaseWeights> robust_weights(const Corrected& fitted, std::span<const double> r,
                                        std::span<const CaseWeights> present);

}  // namespace aspic
