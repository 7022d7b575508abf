#include "dynamics/lagged.h"

#include <algorithm>

#include "dynamics/lead_pins.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr int kMostPasses = 50;
constexpr double kRough = 1e4;      // first tolerance, relative to the one asked for
constexpr int kPure = 7;            // passes without mixtures
constexpr double kReduction = 0.3;  // of the forces by one pass

// The share of an update in the mixture with earlier coefficients. Updates whose forces turn back get less.
class Share {
 public:
  double next(std::span<const double> forces) {
    const double turn = last_.empty() ? 1 : dot(forces, std::span<const double>(last_));
    share_ = turn < 0 ? kLess * share_ : std::min(1.0, kMore * share_);
    last_.assign(forces.begin(), forces.end());
    return share_;
  }

 private:
  static constexpr double kLess = 0.5, kMore = 1.5;
  double share_ = 1;
  std::vector<double> last_;
};

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
  int passes = 1;
  Share share;
  std::vector<double> forces(initial.x.size());
  for (; is_success(report.status); ++passes) {
    if (passes == kMostPasses) {
      report.status = Status::inaccurate;
      break;
    }
    tools.E.update_lagged(initial.x);
    const auto add = [&](const MinimizeReport& next) {
      const MinimizeReport before = report;
      report = next;
      add_work(before, report);
    };
    add(minimize({initial.x}, none));
    if (report.status != Status::iteration_limit) break;
    const double reduced = report.threshold > 0 ? kReduction * report.reached / report.threshold : 1;
    rough.tolerance = options.tolerance * std::max(1.0, reduced);
    double share_of_update = 1;
    if (passes >= kPure) {
      tools.E.gradient(initial.x, forces);
      ++report.gradients;
      share_of_update = share.next(forces);
    }
    tools.E.mix_lagged(share_of_update);
    add(minimize({initial.x}, rough));
  }
  solve.passes = std::max(solve.passes, passes);
  return report;
}

}  // namespace aspic
