// Shared by the fitting methods: f(p) = |r|^2 / 2 + weight R with derivatives, counters and observer calls.
#pragma once
#include <span>
#include <vector>

#include "estimate/fit.h"
#include "math/vectors.h"

namespace aspic {

struct FitPoint {
  std::vector<double> p, r;
  double misfit = 0, roughness = 0;

  double objective(double weight) const { return misfit + weight * roughness; }
};

class FitRun {
 public:
  FitRun(LeastSquares& data, Regularizer& regularizer, const FitOptions& chosen, const FitObserver& observe)
      : options(chosen), data_(data), regularizer_(regularizer), observe_(observe) {}

  const FitOptions& options;
  double weight = 1;
  int start = 0;
  FitReport report;

  LeastSquares& data() { return data_; }
  Regularizer& prior() { return regularizer_; }
  int parameter_count() const { return data_.parameter_count(); }
  int residuals() const { return data_.residual_count(); }
  int readings() const { return data_.reading_count(); }
  // Returns false if r is undefined or not finite at p.
  bool evaluate(std::span<const double> p, FitPoint& point);
  bool linearize(const FitPoint& at);  // linearizes J at this point; false if it does not exist
  void gradient(const FitPoint& at, std::span<double> g);
  void multiply(std::span<const double> dp, std::span<double> dr);
  void multiply_transposed(std::span<const double> w, std::span<double> pbar);
  void add_prior_product(const FitPoint& at, std::span<const double> v, double scale, std::span<double> y) const;
  void multiply_curvature(const FitPoint& at, std::span<const double> v, std::span<double> y);  // (J'J + weight R'') v
  void solve_prior(std::span<const double> p, std::span<const double> v, std::span<double> z);  // R''^-1 v

  // Appends the iteration to the history and calls the observer.
  void note(FitIteration iteration, const FitPoint& at);
  int iterations_left() const { return options.max_iterations - static_cast<int>(report.history.size()); }
  bool is_stopped() const { return options.stop.stopped(); }
  Status stop_status() const { return options.stop.requested() ? Status::interrupted : Status::budget; }

 private:
  LeastSquares& data_;
  Regularizer& regularizer_;
  const FitObserver& observe_;
  std::vector<double> evaluated_;  // p of the last successful evaluation
  std::vector<double> dr_;
};

// Goal of a method: a fraction of the first decrement, or an absolute one, but at least one step for a new weight. The
// first decrement is kept from weight to weight.
struct FitGoal {
  double tolerance = 1e-3;
  double enough = 0;
  bool is_new = false;
  double first_decrement = 0;  // 0: unknown

  bool is_reached(double decrement) {
    if (first_decrement == 0) first_decrement = decrement;
    const bool is_small = decrement <= enough && !is_new;
    is_new = false;
    return is_small || decrement <= tolerance * first_decrement;
  }
};

// Each method minimizes from `at` with the weight of the run, and writes the best point to `at`.
Status levenberg_marquardt(FitRun& run, FitPoint& at, FitGoal& goal);
Status gauss_newton_cg(FitRun& run, FitPoint& at, FitGoal& goal);

using FitMethod = Status (*)(FitRun&, FitPoint&, FitGoal&);

// Choose the weight and return its p: |r|^2 equal to the number of residuals, or largest evidence.
Status fit_by_discrepancy(FitRun& run, FitPoint& at, FitGoal& goal, FitMethod method);
Status fit_by_evidence(FitRun& run, FitPoint& at, FitGoal& goal, FitMethod method);

// Step along d from `at`, with backtracking if f decreases too little or is undefined. False: no step found.
struct FitStep {
  double length = 0;  // accepted step length, relative to d
  int trials = 0;
};
bool search_along(FitRun& run, FitPoint& at, std::span<const double> d, double slope, FitStep& step);

// Whether the expected decrease is below the noise of f, which is computed from equilibria.
bool is_lost_in_noise(double decrement, double objective);

}  // namespace aspic
