#include "dynamics/lagged.h"

#include <algorithm>

namespace aspic {

MinimizeReport minimize_lagged(const StepTools& tools, const MinimizeOptions& options, InitialIterate initial,
                               StepSolve& solve) {
  MinimizeOptions with_updates = options;
  with_updates.updates_lagged = options.lag_at.empty();
  if (!options.lag_at.empty()) {
    tools.E.terms().update_lagged(options.lag_at, false);
    initial.value.reset();
  }
  const MinimizeReport report =
      tools.minimizer.minimize(tools.E, tools.direction, initial, with_updates, tools.observe);
  solve.decrement = std::max(solve.decrement, report.decrement / tools.E.scales().gradient_unit);
  solve.passes = std::max(solve.passes, 1 + report.updates);
  return report;
}

}  // namespace aspic
