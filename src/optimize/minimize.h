// Gradient-based minimization: choose a direction, choose how far, repeat until converged. The lecture's loop, with
// its two slots (direction and step length) left open.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "optimize/line_search.h"
#include "optimize/objective.h"
#include "optimize/search_direction.h"

namespace aspic {

enum class Status {
  converged,        // the criterion is within the tolerance
  round_off,        // no more progress is possible in double precision: as good as converged
  budget,           // the deadline passed first; the result is the best iterate
  iteration_limit,  // max_iterations reached first
  stuck,            // the line search found no decrease
  no_descent,       // no descent direction could be computed
  interrupted,      // the stop token was requested to stop
  undefined,        // value or gradient is not finite at the start
  // Not of a minimization:
  unstable,    // an explicit scheme made most of the energy that the body has
  inaccurate,  // the smallest part of an adaptive time step misses its tolerance
};
inline constexpr int kStatusCount = 10;
std::string_view to_string(Status status);
inline bool is_success(Status status) { return status == Status::converged || status == Status::round_off; }

// What must be small. The last three look at the direction d, of a method for which x + d estimates the minimizer,
// where the Hessian is positive definite; the step along it is still taken.
enum class Criterion {
  // Of the gradient of every part of the objective by itself, such as every body:
  scale,           // |g| <= tolerance * GradientPart::scale: for a time step, the forces that balance
  first_gradient,  // |g| <= tolerance * |g at the first iterate|
  absolute,        // |g| <= tolerance * ObjectiveScales::gradient_unit: for a time step, newtons
  decrement,       // Newton decrement: sqrt(-g.d / 2) <= tolerance * sqrt(ObjectiveScales::value)
  velocity,        // largest |d of a vertex| <= tolerance * h
  acceleration,    // largest |d of a vertex| <= tolerance * h^2
};
std::string_view to_string(Criterion criterion);
std::vector<Criterion> all_criteria();
inline bool judges_direction(Criterion criterion) { return criterion >= Criterion::decrement; }

struct MinimizeOptions {
  int max_iterations = 200;
  double tolerance = 1e-6;
  Criterion criterion = Criterion::scale;
  double h = 1;              // [s], what velocity and acceleration are measured by
  double max_forcing = 0.1;  // the loosest inner linear solve, as a relative residual
  LineSearchOptions line_search;
  StopToken stop = {};  // polled in every iteration
};

struct Iteration {
  int index = 0;
  double value = 0;          // E before the step
  double gradient_norm = 0;  // |g| before the step
  double decrement = 0;      // Newton decrement: -g.d / 2
  double alpha = 0;          // accepted step length; 0 when there was none, which ends the minimization
  int trials = 0;            // evaluations by the line search
  int gradients = 0;         // evaluations in all
  int retreats = 0;          // how often a direction was of no use and another way was taken
  DirectionReport direction;
  double line_search_seconds = 0, gradient_seconds = 0;  // wall time
};

// An iteration and what it was made of. The references are valid only while the observer is being called, which may
// evaluate E wherever it likes: that changes no bit of the result.
struct LiveIteration : Iteration {
  Objective& E;
  std::span<const double> x, g, d;  // before the step
  std::span<const double> x_next;   // after it
  std::span<const Trial> tried;     // by the line search
};

struct MinimizeReport : Work {
  Status status = Status::iteration_limit;
  int iterations = 0;
  double value = 0, gradient_norm = 0, first_gradient_norm = 0;
  double reached = 0,
         threshold = 0;           // what the criterion looks at (|g| of the worst part, or a size of d), and its bound
  double gradient_round_off = 0;  // the part of |g| that is noise
  double lost_accuracy = 0;       // see HasParts::lost_accuracy(); the status is then round_off
  double decrement = 0;           // -g.d / 2 of the last iteration; 0 without one
  int trials = 0, retreats = 0, projected_hessians = 0, projected_elements = 0;
};

using IterationObserver = std::function<void(const LiveIteration&)>;

class Minimizer {  // holds the scratch vectors, so that repeated calls allocate nothing
 public:
  Minimizer();
  ~Minimizer();
  Minimizer(Minimizer&&) noexcept;
  Minimizer& operator=(Minimizer&&) noexcept;

  // Throws InvalidInput when the criterion judges directions and those of the method say nothing about the distance.
  MinimizeReport minimize(Objective& E, SearchDirection& direction, std::span<double> x, const MinimizeOptions& options,
                          const IterationObserver& observe = {});
  // The same where E(x) is known already.
  MinimizeReport minimize(Objective& E, SearchDirection& direction, std::span<double> x, const Evaluation& value,
                          const MinimizeOptions& options, const IterationObserver& observe = {});

  // The bound of |g| for each part in the last minimization, where the criterion judges the gradient.
  std::span<const double> thresholds() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
