// Levenberg-Marquardt within bounds, for few unknowns of which some may end exactly at a bound: coefficients that must
// not be negative. (fit.h maps bounded quantities smoothly to the whole line, where a bound is infinitely far away.)
// Each iteration minimizes the damped Gauss-Newton model over the box, exactly [Nocedal 2006, alg. 16.3].
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
  double tolerance = 1e-10;  // of the decrease of |r|^2 that a step predicts, relative to |r|^2
};

struct BoundedFit {
  bool is_converged = false;
  std::vector<double> p;
  std::vector<bool> at_bound;
  double objective = 0;           // |r|^2 / 2
  std::vector<double> deviation;  // of p, from the scatter of the residuals; 0 at a bound, infinite if undetermined
  int iterations = 0, evaluations = 0;
};

// From `guess`, clipped to the box. Not converged and p empty: the residuals are not defined at the guess.
BoundedFit minimize_within(LeastSquares& problem, std::span<const double> guess, std::span<const Bounds> bounds,
                           const BoundedFitOptions& options = {});

}  // namespace aspic
