#include "dynamics/lagged.h"

#include <algorithm>

#include "dynamics/lead_pins.h"

namespace aspic {
namespace {

constexpr int kMostPasses = 50;

}  // namespace

MinimizeReport minimize_lagged(const StepTools& tools, const MinimizeOptions& options, InitialIterate initial,
                               StepSolve& solve) {
  const auto minimize = [&](InitialIterate at) {
    const MinimizeReport report = tools.minimizer.minimize(tools.E, tools.direction, at, options, tools.observe);
    solve.decrement = std::max(solve.decrement, report.decrement / tools.E.scales().gradient_unit);
    return report;
  };
  MinimizeReport report = minimize(initial);
  int passes = 1;
  for (; is_success(report.status) && tools.E.update_lagged(initial.x); ++passes) {
    if (passes == kMostPasses) {
      report.status = Status::inaccurate;
      break;
    }
    MinimizeReport next = minimize({initial.x});
    const bool is_settled = next.iterations == 0;
    add_work(report, next);
    report = next;
    if (is_settled) break;
  }
  solve.passes = std::max(solve.passes, passes);
  return report;
}

}  // namespace aspic
