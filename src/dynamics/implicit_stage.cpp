#include "dynamics/implicit_stage.h"

#include <algorithm>

#include "dynamics/advance_boundary.h"
#include "dynamics/lagged.h"

namespace aspic {
namespace {

MinimizeOptions one_iteration(const MinimizeOptions& options) {
  MinimizeOptions one = options;
  one.max_iterations = 1;
  one.max_forcing = 1e-10;
  one.line_search.test = DecreaseTest::none;
  one.line_search.alpha_max = 1;
  return one;
}

}  // namespace

// The accelerations x'' of pinned vertices are known: q~ = x(t*) - beta^2 x'' includes their inertia M_fp x'' in the
// equations of the free vertices, and a = x(t*) - beta x' their contribution to damping.
void ImplicitStage::predict(const StepTools& tools, const StageOptions& options) {
  const double beta = options.beta;
  const PinPath* path = options.path;
  predicted_.resize(a.size());
  if (!path) {
    for (size_t i = 0; i < a.size(); ++i) predicted_[i] = a[i] + beta * b[i];
    return;
  }
  // In the pinned directions, a, b and predicted_ first receive x, x' and x''.
  tools.pins.place(options.time, a);
  path->place_velocity(options.time, b);
  std::fill(predicted_.begin(), predicted_.end(), 0.0);
  path->place_acceleration(options.time, predicted_);
  for (int v = 0; v < tools.pins.rows(); ++v) {
    const Vec3d velocity = point(b, v), dx = tools.pins.held_part(v, velocity), ddx = point(predicted_, v);
    const bool is_held = tools.pins.holds(v), is_free = tools.pins.is_free(v);
    for (int r = 0; r < 3; ++r) {
      const int i = 3 * v + r;
      const double x = a[i];
      if (!is_free) a[i] -= beta * dx[r], b[i] -= beta * ddx[r];
      predicted_[i] = is_held ? x - beta * beta * ddx[r] : a[i] + beta * b[i];
    }
  }
}

MinimizeReport ImplicitStage::minimize(const StepTools& tools, const StageOptions& options,
                                       const StageVariables& variables, StepSolve& solve) {
  q_.assign(variables.q.begin(), variables.q.end());
  MinimizeOptions minimize = options.once ? one_iteration(tools.options) : tools.options;
  minimize.h = options.beta;
  minimize.stop = tools.options.stop.at_fraction(options.budget_fraction);
  if (options.once) {
    tools.pins.place(options.time, q_);
    solve.guess = InitialGuess::current;
    MinimizeReport report = tools.minimizer.minimize(tools.E, tools.direction, q_, minimize, tools.observe);
    // The scheme performs one iteration for any gradient; the residual is in the report.
    if (report.status == Status::iteration_limit) report.status = Status::converged;
    solve.decrement = std::max(solve.decrement, report.decrement / tools.E.scales().gradient_unit);
    return report;
  }
  MinimizeReport guessing;
  const GuessContext known{.q = variables.q,
                           .qdot = variables.v,
                           .ahead = options.ahead,
                           .time = options.time,
                           .predicted = predicted_,
                           .beta = options.beta,
                           .tries_last_increment = options.tries_last_increment};
  const Guess guess = guesser_.guess(tools, tools.guess, known, q_, guessing);
  solve.guess = guess.used;
  MinimizeReport report = minimize_lagged(tools, minimize, {q_, guess.value}, solve);
  add_work(guessing, report);
  return report;
}

bool ImplicitStage::solve(const StepTools& tools, const StageOptions& options, const StageVariables& variables,
                          StepSolve& solve, StepForces& forces) {
  const double beta = options.beta;
  const auto& [q, v, acc] = variables;
  predict(tools, options);
  StepContext context{a, beta, options.time, tools.start.q, tools.obstacle_start};
  if (options.previous) context.obstacle_before = options.previous->time;
  tools.E.at({.predicted = predicted_,
              .factor = beta * beta,
              .context = context,
              .internal = tools.start.internal,
              .duration = beta});
  if (!solve.add(minimize(tools, options, variables, solve))) return false;

  std::copy(q_.begin(), q_.end(), q.begin());
  for (size_t i = 0; i < q.size(); ++i) v[i] = (q[i] - a[i]) / beta;
  for (size_t i = 0; i < q.size(); ++i) acc[i] = (v[i] - b[i]) / beta;
  if (const PinPath* path = options.path) {  // avoids the round-off of the two differences
    path->place_velocity(options.time, v);
    path->place_acceleration(options.time, acc);
  }
  forces.add(tools.E, options.weight, q, acc, solve.work);
  forces.add_bounds(tools, options.once ? ResidualBound::none : ResidualBound::threshold, options.weight, q);
  return true;
}

}  // namespace aspic
