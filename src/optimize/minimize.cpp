#include "optimize/minimize.h"

#include <algorithm>
#include <cmath>

namespace aspic {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::round_off:
      return "round_off";
    case Status::iteration_limit:
      return "iteration_limit";
    case Status::stuck:
      return "stuck";
    case Status::no_descent:
      return "no_descent";
    case Status::interrupted:
      return "interrupted";
    case Status::undefined:
      return "undefined";
  }
  return "unknown";
}

std::string_view to_string(Criterion criterion) {
  switch (criterion) {
    case Criterion::scale:
      return "scale";
    case Criterion::first_gradient:
      return "first_gradient";
    case Criterion::absolute:
      return "absolute";
  }
  return "unknown";
}

namespace {

double threshold(const Objective& E, const MinimizeOptions& options, double first_gradient_norm) {
  switch (options.criterion) {
    case Criterion::scale:
      return options.tolerance * E.gradient_scale();
    case Criterion::first_gradient:
      return options.tolerance * first_gradient_norm;
    case Criterion::absolute:
      return options.tolerance;
  }
  return 0;
}

// Inner solves are loose while the minimum is far away and tight near it, so that convergence stays superlinear
// [Eisenstat and Walker 1996].
double forcing(double gradient_ratio, const MinimizeOptions& options) {
  return std::min(options.max_forcing, std::max(1e-8, std::sqrt(gradient_ratio)));
}

// A line search that fails this close to the round-off of the gradient has nothing left to find.
constexpr double kRoundOffMargin = 100;
// Round-off is as good as convergence only where it is small beside what the gradient is made of.
constexpr double kResolved = 1e-3;

bool is_round_off(const Objective& E, double gradient_norm, double margin) {
  const double round_off = E.gradient_round_off();
  return std::isfinite(round_off) && gradient_norm <= margin * round_off &&
         gradient_norm <= kResolved * E.gradient_scale();
}

}  // namespace

MinimizeReport Minimizer::minimize(Objective& E, SearchDirection& direction, std::span<double> x,
                                   const MinimizeOptions& options, const IterationObserver& observe) {
  for (auto* v : {&g_, &d_, &trial_, &trial_gradient_}) v->resize(x.size());
  MinimizeReport report;
  report.value = E.value(x);
  E.gradient(x, g_);
  for (int i = 0;; ++i) {
    report.iterations = i;
    report.gradient_norm = std::sqrt(E.dot(g_, g_));
    if (i == 0) report.first_gradient_norm = report.gradient_norm;
    report.threshold = threshold(E, options, report.first_gradient_norm);
    if (!std::isfinite(report.value) || !std::isfinite(report.gradient_norm))
      return report.status = Status::undefined, report;
    if (report.gradient_norm <= report.threshold) return report.status = Status::converged, report;
    if (is_round_off(E, report.gradient_norm, 1)) return report.status = Status::round_off, report;
    if (i == options.max_iterations) return report.status = Status::iteration_limit, report;

    Iteration iteration;
    iteration.index = i;
    iteration.value = report.value;
    iteration.gradient_norm = report.gradient_norm;
    const double loose = forcing(report.gradient_norm / report.first_gradient_norm, options);
    const bool found = direction.compute(E, x, g_, loose, d_, iteration.direction);
    report.hessians += iteration.direction.hessians;
    report.linear_iterations += iteration.direction.linear_iterations;
    report.projected_hessians += iteration.direction.projected;
    const double slope = found ? E.dot(g_, d_) : 0;
    if (!(slope < 0)) return report.status = Status::no_descent, report;

    const LineSearchResult step =
        backtrack(E, x, d_, report.value, slope, options.line_search, trial_, trial_gradient_);
    report.trials += step.trials;
    if (step.alpha == 0) {
      const bool at_floor = is_round_off(E, report.gradient_norm, kRoundOffMargin);
      return report.status = at_floor ? Status::round_off : Status::stuck, report;
    }
    std::copy(trial_.begin(), trial_.end(), x.begin());
    report.value = step.value;
    if (step.gradient_known)
      g_.swap(trial_gradient_);
    else
      E.gradient(x, g_);

    iteration.decrement = -0.5 * slope;
    iteration.alpha = step.alpha;
    iteration.trials = step.trials;
    if (observe && !observe(iteration)) return report.iterations = i + 1, report.status = Status::interrupted, report;
  }
}

}  // namespace aspic
