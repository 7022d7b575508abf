// Minimises |r(p)|^2 / 2 + weight R(p): the material that explains the measurements.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/deadline.h"
#include "fit/least_squares.h"
#include "fit/regularizer.h"
#include "optimize/minimize.h"

namespace aspic {

struct FitOptions {
  std::string method = "auto";  // "levenberg_marquardt" (few unknowns), "gauss_newton_cg", "lbfgs" (fields)
  double tolerance = 1e-4;      // of the gradient in the norm of the preconditioner, relative to the first one
  int max_iterations = 100;
  double weight = -1;                       // of the regulariser; < 0: chosen by `weight_rule`
  std::string weight_rule = "discrepancy";  // or "l_curve"
  int starts = 1;                           // from how many guesses; the best is kept
};

struct FitIteration {
  int index = 0;
  double weight = 0, misfit = 0 /* |r|^2 / 2 */, roughness = 0 /* R */, objective = 0, gradient_norm = 0;
  double step = 0;  // |dp|
  int inner = 0;    // of the linear solve
};
using FitObserver = std::function<bool(const FitIteration&, std::span<const double> p)>;  // false: stop here

struct WeightTrial {  // a point of the L-curve
  double weight = 0, misfit = 0, roughness = 0;
  std::vector<double> p;
};

struct FitReport {
  Status status = Status::iteration_limit;
  std::vector<double> p;
  double weight = 0, misfit = 0, roughness = 0;
  int iterations = 0, evaluations = 0;
  std::vector<FitIteration> history;
  std::vector<WeightTrial> weights;  // all that were tried, ascending
  std::vector<double> starts;        // the objective reached from each start
  std::string words;                 // why it ended, for people
};

FitReport fit(LeastSquares& misfit, Regularizer& regularizer, std::span<const double> guess, const FitOptions& options,
              const FitObserver& observe = {});

}  // namespace aspic
