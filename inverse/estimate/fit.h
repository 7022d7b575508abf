// Fits a material to measurements by minimizing |r(p)|^2 / 2 + weight R(p).
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/stop_token.h"
#include "model/least_squares.h"
#include "model/regularizer.h"
#include "optimize/minimize.h"

namespace aspic {

struct FitOptions {
  std::string method = "auto";       // "levenberg_marquardt" (few parameters), "gauss_newton_cg" (fields)
  double tolerance = 1e-3;           // tolerance of FitIteration::decrement, relative to the first one
  double enough = 0.3;               // absolute threshold for fields, in standard deviations of the posterior
  int max_iterations = 100;          // total over all stages
  int max_inner = 100;               // maximum iterations of conjugate gradients, per iteration
  double max_step = 3;               // per entry of p and iteration: log E by 3, E by 20
  double weight = -1;                // weight of the regularizer; < 0: chosen by `weight_rule`
  std::string weight_rule = "auto";  // weight_rule_names(); auto: "prior" (1) for few parameters, else "discrepancy"
  double first_weight = 0;           // first weight of a rule; 0: prior and data about equal
  int starts = 1;                    // number of initial guesses; the best result is kept
  double scatter = 1.5;              // largest change of p between initial guesses
  StopToken stop = {};               // polled in every iteration and trial; the result is the best p so far
};
std::vector<std::string> fit_method_names();
std::vector<std::string> weight_rule_names();

struct FitIteration {
  int index = 0, start = 0;
  double weight = 0, misfit = 0 /* |r|^2 / 2 */, roughness = 0 /* R */, objective = 0;  // at the end of the step
  double decrement = 0;  // sqrt(g' H^-1 g) at the start, H = J'J + weight R'': in posterior standard deviations
  double step = 0;       // largest entry of dp
  int inner = 0;         // iterations of the linear solve
  int trials = 0;        // evaluations
};
using FitObserver = std::function<void(const FitIteration&, std::span<const double> p)>;

struct WeightTrial {
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
  std::vector<WeightTrial> weights;  // all tried weights, ascending
  std::vector<double> starts;        // final objective per initial guess; NaN: failed
  std::string message;               // reason for the end, as a sentence

  bool has_material() const { return !p.empty() && status != Status::undefined; }
};

// Starts from `guess`, or from the p of a stopped fit (with its weight as `first_weight`). Throws InvalidInput for
// invalid options. Afterwards `misfit` is evaluated at p.
FitReport fit(LeastSquares& misfit, Regularizer& regularizer, std::span<const double> guess, const FitOptions& options,
              const FitObserver& observe = {});

}  // namespace aspic
