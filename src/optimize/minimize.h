// Gradient-based minimization: computes a direction, searches along it, and repeats until converged. The search
// direction and the line search are exchangeable.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "optimize/line_search.h"
#include "optimize/objective.h"
#include "optimize/search_direction.h"

namespace aspic {

enum class Status {
  converged,        // the criterion is met
  round_off,        // no further progress is possible in double precision; a success
  budget,           // the deadline passed first; the result is the best iterate
  iteration_limit,  // max_iterations reached first
  stuck,            // the line search found no decrease
  no_descent,       // no descent direction was found
  interrupted,      // the stop token was requested to stop
  undefined,        // the value or the gradient is not finite at the initial guess
  // Only for time steps:
  unstable,    // an explicit scheme generated most of the energy of the body
  inaccurate,  // the smallest substep of an adaptive time step exceeds its tolerance, or lagged coefficients of E do
               // not settle in kMaxUpdates updates
  inverted,    // converged, but quadratic tets are inverted between their nodes, where their law is infinite
};
inline constexpr int kMaxUpdates = 50;  // of lagged coefficients in a minimization
inline constexpr int kStatusCount = 10;
std::string_view to_string(Status status);
inline bool is_success(Status status) { return status == Status::converged || status == Status::round_off; }

// Convergence criteria. The first three test the gradient g of each part of the objective, such as each body. The last
// three test the direction d. They require a method for which x + d estimates the minimizer, and a positive definite
// Hessian; the step along d is still performed.
enum class Criterion {
  scale,           // |g| <= tolerance * GradientPart::scale; in a time step relative to the forces in balance
  first_gradient,  // |g| <= tolerance * |g at the first iterate|
  absolute,        // |g| <= tolerance * ObjectiveScales::gradient_unit; in a time step in newtons
  decrement,       // Newton decrement: sqrt(-g.d / 2) <= tolerance * sqrt(ObjectiveScales::value)
  velocity,        // largest |d| of a vertex <= tolerance * h
  acceleration,    // largest |d| of a vertex <= tolerance * h^2
};
std::string_view to_string(Criterion criterion);
std::vector<Criterion> all_criteria();  // in the order above
inline bool tests_direction(Criterion criterion) { return criterion >= Criterion::decrement; }

struct MinimizeOptions {
  int max_iterations = 200;  // then the status is `iteration_limit`
  double tolerance = 1e-6;   // its unit depends on the criterion
  Criterion criterion = Criterion::scale;
  double h = 1;                         // time step for the criteria velocity and acceleration [s]
  double max_forcing = 0.1;             // largest relative residual of inner linear solves
  bool updates_lagged = false;          // whether lagged coefficients are updated between iterations, see HasLag
  std::span<const double> lag_at = {};  // iterate at which a time step evaluates them instead; empty: updates them
  LineSearchOptions line_search;
  StopToken stop = {};  // polled in every iteration
};

// Record of one iteration. Units are those of the objective.
struct Iteration {
  int index = 0;             // 0 for the first
  double value = 0;          // E before the step
  double gradient_norm = 0;  // |g| before the step
  double decrement = 0;      // Newton decrement: -g.d / 2
  double alpha = 0;          // accepted step length; 0: none, which ends the minimization
  int trials = 0;            // evaluations of E by the line search
  int gradients = 0;         // evaluations of the gradient
  int fallbacks = 0;         // number of fallbacks to a more cautious direction
  DirectionReport direction;
  double line_search_seconds = 0, gradient_seconds = 0;  // wall time
};

// An iteration with its vectors, as passed to observers. The references are valid only during the call. An observer may
// evaluate E anywhere without changing the result.
struct LiveIteration : Iteration {
  Objective& E;
  std::span<const double> x, g, d;  // before the step
  std::span<const double> x_next;   // after the step
  std::span<const Trial> tried;     // trials of the line search
};

// Result of a minimization. Units are those of the objective.
struct MinimizeReport : Work {
  Status status = Status::iteration_limit;
  int iterations = 0;
  double value = 0, gradient_norm = 0;  // E and |g| at the returned x
  double reached = 0;                   // the tested quantity: |g| of the worst part, or a norm of d
  double threshold = 0;                 // its threshold
  double gradient_round_off = 0;        // norm of the rounding error of the gradient
  double lost_accuracy = 0;             // see HasParts::lost_accuracy(); if positive, the status is round_off
  double decrement = 0;                 // -g.d / 2 of the last iteration; 0 without one
  int trials = 0, fallbacks = 0, projected_hessians = 0, projected_elements = 0;
  int updates = 0;  // updates of lagged coefficients
  int carries = 0;  // of a time step: Newton directions along which bodies moved with obstacles
};

// Called after every iteration.
using IterationObserver = std::function<void(const LiveIteration&)>;

// The initial guess of a minimization; x receives the result.
struct InitialIterate {
  InitialIterate(std::span<double> initial) : x(initial) {}
  InitialIterate(std::vector<double>& initial) : x(initial) {}
  InitialIterate(std::span<double> initial, const Evaluation& E_of_x) : x(initial), value(E_of_x) {}

  std::span<double> x;              // 3 entries per block row
  std::optional<Evaluation> value;  // E(x), if known
};

// Reuses its scratch vectors, so that repeated calls do not allocate.
class Minimizer {
 public:
  Minimizer();
  ~Minimizer();
  Minimizer(Minimizer&&) noexcept;
  Minimizer& operator=(Minimizer&&) noexcept;

  // Minimizes E from initial.x and writes the best iterate to it. Throws InvalidInput if the criterion tests
  // directions, but those of the method do not estimate the minimizer.
  MinimizeReport minimize(Objective& E, SearchDirection& direction, InitialIterate initial,
                          const MinimizeOptions& options, const IterationObserver& observe = {});

  // Returns the threshold of |g| of each part in the last minimization, if its criterion tests the gradient.
  std::span<const double> thresholds() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
