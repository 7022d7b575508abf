// Minimizes |r(p)|^2 / 2 + weight R(p): the material that explains the measurements.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/stop_token.h"
#include "fit/least_squares.h"
#include "fit/regularizer.h"
#include "optimize/minimize.h"

namespace aspic {

struct FitOptions {
  std::string method = "auto";       // "levenberg_marquardt" (few unknowns), "gauss_newton_cg", "lbfgs" (fields)
  double tolerance = 1e-3;           // of FitIteration::decrement, relative to the first one
  double enough = 0.3;               // and this is small enough for fields: standard deviations of what is known
  int max_iterations = 100;          // in all
  int max_inner = 100;               // of conjugate gradients, per iteration
  double max_step = 3;               // of any entry of p, per iteration: log E by 3, E by 20
  double weight = -1;                // of the regularizer; < 0: chosen by `weight_rule`
  std::string weight_rule = "auto";  // weight_rule_names(); auto: "prior" (1) for few unknowns, else "discrepancy"
  double first_weight = 0;           // where a rule begins; 0: where the prior and the data are about as strong
  int starts = 1;                    // from how many guesses; the best is kept
  double scatter = 1.5;              // the largest change of p from the first guess to another
  StopToken stop = {};               // polled in every iteration and trial; the result is the best p
};
std::vector<std::string> fit_method_names();
std::vector<std::string> weight_rule_names();

struct FitIteration {
  int index = 0, start = 0;
  double weight = 0, misfit = 0 /* |r|^2 / 2 */, roughness = 0 /* R */, objective = 0;  // where the step ends
  double decrement =
      0;            // sqrt(g' H^-1 g) where it began, H = J'J + weight R'': in standard deviations of what is known
  double step = 0;  // largest entry of dp
  int inner = 0;    // of the linear solve
  int trials = 0;   // evaluations
};
using FitObserver = std::function<void(const FitIteration&, std::span<const double> p)>;

struct WeightTrial {  // a point of the L-curve
  double weight = 0, misfit = 0, roughness = 0;
  std::vector<double> p;
};

struct FitReport {
  Status status = Status::iteration_limit;
  std::vector<double> p;
  double weight = 0, misfit = 0, roughness = 0;
  int iterations = 0, evaluations = 0, products = 0;  // products: with J or its transpose
  std::string method;
  std::vector<FitIteration> history;
  std::vector<WeightTrial> weights;  // all that were tried, ascending
  std::vector<double> starts;        // the objective reached from each start; NaN: none could be computed
  std::string words;                 // why it ended, for people
};

// From `guess`, or on from the p of a fit that was stopped (with its weight as `first_weight`). Throws InvalidInput for
// options that are no good. After it, `misfit` was last evaluated at p.
FitReport fit(LeastSquares& misfit, Regularizer& regularizer, std::span<const double> guess, const FitOptions& options,
              const FitObserver& observe = {});

}  // namespace aspic
