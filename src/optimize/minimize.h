// Gradient-based minimisation: choose a direction, choose how far, repeat until converged. The lecture's loop, with
// its two slots (direction and step length) left open.
#pragma once
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "optimize/line_search.h"
#include "optimize/objective.h"
#include "optimize/search_direction.h"

namespace aspic {

enum class Status {
  converged,        // the gradient is within the tolerance
  round_off,        // no more progress is possible in double precision: as good as converged
  iteration_limit,  // max_iterations reached first
  stuck,            // the line search found no decrease
  no_descent,       // no descent direction could be computed
  interrupted,      // the observer asked to stop
  undefined,        // value or gradient is not finite at the start
};
std::string_view to_string(Status status);
inline bool is_success(Status status) { return status == Status::converged || status == Status::round_off; }

// What `tolerance` is relative to.
enum class Criterion {
  scale,           // |g| <= tolerance * objective.gradient_scale(): for a time step, the forces that balance
  first_gradient,  // |g| <= tolerance * |g at the first iterate|
  absolute,        // |g| <= tolerance
};
std::string_view to_string(Criterion criterion);

struct MinimizeOptions {
  int max_iterations = 50;
  double tolerance = 1e-6;
  Criterion criterion = Criterion::scale;
  double max_forcing = 0.1;  // the loosest inner linear solve, as a relative residual
  LineSearchOptions line_search;
};

struct Iteration {
  int index = 0;
  double value = 0;          // E before the step
  double gradient_norm = 0;  // |g| before the step
  double decrement = 0;      // Newton decrement: -g.d / 2
  double alpha = 0;          // accepted step length
  int trials = 0;            // evaluations by the line search
  DirectionReport direction;
};

struct MinimizeReport {
  Status status = Status::iteration_limit;
  int iterations = 0;
  double value = 0, gradient_norm = 0, first_gradient_norm = 0;
  double threshold = 0;  // the |g| that was asked for
  int trials = 0, hessians = 0, linear_iterations = 0, projected_hessians = 0;
};

using IterationObserver = std::function<bool(const Iteration&)>;  // false: stop here

class Minimizer {  // holds the scratch vectors, so that repeated calls allocate nothing
 public:
  MinimizeReport minimize(Objective& E, SearchDirection& direction, std::span<double> x, const MinimizeOptions& options,
                          const IterationObserver& observe = {});

 private:
  std::vector<double> g_, d_, trial_, trial_gradient_;
};

}  // namespace aspic
