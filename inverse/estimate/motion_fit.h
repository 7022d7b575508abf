// Fits parameters of a scene's motion to measured marker positions: L-BFGS with the exact gradient by adjoint time
// steps, preconditioned by J'J, and standard deviations from the Hessian at the solution.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/stop_token.h"
#include "estimate/motion_objective.h"
#include "optimize/minimize.h"

namespace aspic {

struct MotionFitProgress {
  int iteration = 0;
  double rms = 0;       // root mean square distance [m]
  int simulations = 0;  // so far
};

struct MotionFitOptions {
  int max_iterations = 100;
  std::function<void(const MotionFitProgress&)> observe = {};
};

struct FittedMotionValue {
  MotionParameter parameter;
  double value = 0;
  double sigma = 0;          // standard deviation, increased if residuals exceed sigma; infinite if not determined
  std::string message = {};  // the reason
};

struct MotionFitReport {
  Status status = Status::undefined;
  bool stopped = false;   // by the stop token; there are no standard deviations
  std::string message;    // the reason for a failure
  std::vector<double> p;  // values of MotionParameters
  std::vector<FittedMotionValue> values;
  MotionPoint before, after;
  double chi_squared = 0;  // sum of squared residuals / sigma^2 per degree of freedom
  int iterations = 0, simulations = 0, gradients = 0;
};

// Minimizes from p = 0, the guess. Status `undefined`: the motion cannot be simulated there. If the stop token of the
// objective ends the fit, it returns the best parameters so far.
MotionFitReport fit_motion(MotionObjective& objective, const MotionFitOptions& options);

}  // namespace aspic
