// Levenberg-Marquardt with bounds, for few parameters that may end exactly at a bound, such as nonnegative
// coefficients. (fit.h maps bounded quantities smoothly to the whole line, with bounds at infinity.) Each iteration
// minimizes the damped Gauss-Newton model over the box exactly [Nocedal 2006, alg. 16.3].
#pragma once
#include <span>
#include <vector>

#include "fit/least_squares.h"

namespace aspic {

struct Bounds {
  double lower = 0, upper = 0;
};

struct BoundedFitOptions {
  int max_iterations = 300;
  double tolerance = 1e-10;  // predicted relative decrease of |r|^2
};

struct BoundedFit {
  bool is_converged = false;
  std::vector<double> p;
  std::vector<bool> at_bound;
  double objective = 0;       // |r|^2 / 2
  std::vector<double> sigma;  // sigma of p, from the scatter of r; 0 at a bound, infinite if undetermined
  int iterations = 0, evaluations = 0;
};

// Starts from `guess`, clipped to the box. Residuals undefined at the guess: not converged, with an empty p.
BoundedFit minimize_within(LeastSquares& problem, std::span<const double> guess, std::span<const Bounds> bounds,
                           const BoundedFitOptions& options = {});

}  // namespace aspic
