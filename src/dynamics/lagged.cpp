#include "dynamics/lagged.h"

#include <algorithm>
#include <limits>

#include "dynamics/lead_pins.h"

namespace aspic {
namespace {

constexpr int kMaxPasses = 50;
constexpr double kRough = 1e4;      // first tolerance, relative to the requested one
constexpr double kReduction = 0.3;  // of the forces by one pass
constexpr double kProgress = 0.9;   // passes that reduce the forces by less are stalled
constexpr double kNoise = 100;      // forces below this multiple of their rounding error are noise
constexpr int kStalled = 3;         // passes that end in noise before the step ends there

}  // namespace

// The first minimization and each further one end when the forces have fallen enough for an update of the coefficients
// to be worth more than further iterations.
MinimizeReport minimize_lagged(const StepTools& tools, const MinimizeOptions& options, InitialIterate initial,
                               StepSolve& solve) {
  const auto minimize = [&](InitialIterate at, const MinimizeOptions& how) {
    const MinimizeReport report = tools.minimizer.minimize(tools.E, tools.direction, at, how, tools.observe);
    solve.decrement = std::max(solve.decrement, report.decrement / tools.E.scales().gradient_unit);
    return report;
  };
  if (!tools.E.is_lagged()) return minimize(initial, options);
  MinimizeOptions rough = options, none = options;
  rough.tolerance = kRough * options.tolerance;
  none.max_iterations = 0;
  MinimizeReport report = minimize(initial, rough);
  int passes = 1, stalled = 0;
  double least = std::numeric_limits<double>::infinity();
  for (; is_success(report.status); ++passes) {
    tools.E.update_lagged(initial.x);
    const auto add = [&](const MinimizeReport& next) {
      const MinimizeReport before = report;
      report = next;
      add_work(before, report);
    };
    const MinimizeReport solved = report;
    add(minimize({initial.x}, none));
    if (report.status != Status::iteration_limit) break;
    stalled = report.reached < kProgress * least ? 0 : stalled + 1;
    least = std::min(least, report.reached);
    const bool is_noise = report.reached <= kNoise * tools.E.scales().gradient_round_off;
    if (solved.status == Status::round_off && is_noise && stalled == kStalled) {
      report.status = Status::round_off;
      break;
    }
    if (passes == kMaxPasses) {
      report.status = Status::inaccurate;
      break;
    }
    const double reduced = report.threshold > 0 ? kReduction * report.reached / report.threshold : 1;
    rough.tolerance = options.tolerance * std::max(1.0, reduced);
    add(minimize({initial.x}, rough));
  }
  solve.passes = std::max(solve.passes, passes);
  return report;
}

}  // namespace aspic
