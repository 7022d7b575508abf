#include "optimize/minimize.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/stopwatch.h"
#include "optimize/convergence.h"
#include "optimize/lag_updates.h"

namespace aspic {

// In the order of Status.
constexpr std::string_view kStatusNames[] = {"converged", "round_off",  "budget",      "iteration_limit",
                                             "stuck",     "no_descent", "interrupted", "undefined",
                                             "unstable",  "inaccurate", "inverted"};

std::string_view to_string(Status status) { return kStatusNames[static_cast<size_t>(status)]; }

// In the order of Criterion.
constexpr std::string_view kCriterionNames[] = {"scale",     "first_gradient", "absolute",
                                                "decrement", "velocity",       "acceleration"};

std::string_view to_string(Criterion criterion) { return kCriterionNames[static_cast<size_t>(criterion)]; }

std::vector<Criterion> all_criteria() {
  return {Criterion::scale,     Criterion::first_gradient, Criterion::absolute,
          Criterion::decrement, Criterion::velocity,       Criterion::acceleration};
}

namespace {

void add(const Iteration& iteration, MinimizeReport& report) {
  const DirectionReport& direction = iteration.direction;
  report.add(direction);
  report.values += iteration.trials;
  report.trials += iteration.trials;
  report.gradients += iteration.gradients;
  report.projected_hessians += direction.projected;
  report.projected_elements += direction.projected_elements;
  report.fallbacks += iteration.fallbacks;
  report.decrement = iteration.decrement;
}

// The state of a minimization.
struct Progress {
  Objective& E;
  SearchDirection& direction;
  std::span<double> x;
  const MinimizeOptions& options;
  Evaluation value;
  MinimizeReport report = {};
  double slope = 0;            // g.d
  LineSearchResult step = {};  // result of the last line search
  LagUpdates lag = {};
  bool last_direction = false;  // the criterion holds for this direction
};

// Durations of the phases of the last iteration, by the clock of the deadline [s].
struct Cost {
  double direction = 0, line_search = 0, gradient = 0;
  double stoppable = 0;  // share of `direction` that polls the stop token

  double to_finish() const { return line_search + gradient; }  // time after the direction is computed
  double at_least() const { return direction - stoppable + to_finish(); }
};

}  // namespace

struct Minimizer::Impl {
  using End = std::optional<Status>;  // empty: the minimization continues

  MinimizeReport minimize(Progress& at, const IterationObserver& observe);
  void begin(Progress& at);
  End update_lagged(Progress& at, End end);
  void evaluate_lagged(Progress& at);
  End test_convergence(Progress& at);
  InnerAccuracy inner_accuracy(const Progress& at) const;
  bool find_direction(Progress& at, const Iterate& iterate, Iteration& iteration);
  bool search_line(Progress& at, const StopToken& stop, Iteration& iteration);
  End find_step(Progress& at, Iteration& iteration);
  void take_step(Progress& at, Iteration& iteration);

  std::vector<double> g, d;
  LineSearchScratch line;
  Convergence convergence;
  Cost cost;  // kept between minimizations
};

MinimizeReport Minimizer::Impl::minimize(Progress& at, const IterationObserver& observe) {
  begin(at);
  MinimizeReport& report = at.report;
  const auto ended = [&report](Status status) { return report.status = status, report; };
  for (int i = 0;; ++i) {
    report.iterations = i;
    if (const End end = update_lagged(at, test_convergence(at))) return ended(*end);
    LiveIteration iteration{{.index = i, .value = report.value, .gradient_norm = report.gradient_norm}, at.E};
    const End end = find_step(at, iteration);
    if (!end) take_step(at, iteration);
    add(iteration, report);
    iteration.gradients += iteration.direction.gradients;
    iteration.x = end ? at.x : line.trial;
    iteration.g = end ? g : line.gradient;
    iteration.d = d, iteration.x_next = at.x, iteration.tried = line.trials;
    if (observe) observe(iteration);
    if (at.options.stop.requested()) {
      report.iterations = i + !end;
      return ended(Status::interrupted);
    }
    if (!end) continue;
    if (const End last = update_lagged(at, end)) return ended(*last);
  }
}

void Minimizer::Impl::begin(Progress& at) {
  for (auto* v : {&g, &d, &line.trial, &line.gradient}) v->resize(at.x.size());
  line.trials.reserve(64);
  at.direction.begin();
  HasLag* lagged = at.options.updates_lagged ? at.E.traits().lag : nullptr;
  at.lag.begin(lagged && lagged->is_lagged() ? lagged : nullptr);
  at.E.gradient(at.x, g);
  convergence.begin(at.E, at.options, g);
  at.report.gradients = 1;
}

// Updates lagged coefficients if this is due where the minimization would continue or end otherwise. Returns the final
// status if it ends at this iterate.
Minimizer::Impl::End Minimizer::Impl::update_lagged(Progress& at, End end) {
  MinimizeReport& report = at.report;
  if (!at.lag.is_due(report, end)) return end;
  if (end) at.E.note_newton_step({}, {}, 0);  // the minimizer is that of E with the coefficients at x
  at.lag.update(at.x);
  ++report.updates;
  evaluate_lagged(at);
  const End updated = test_convergence(at);
  const End last = at.lag.end_after(report, at.E.scales().gradient_round_off, end, updated);
  if (!last && at.lag.relax(end.has_value())) {
    evaluate_lagged(at);
    test_convergence(at);  // for the report: only coefficients of this iterate end the minimization
  }
  return last;
}

void Minimizer::Impl::evaluate_lagged(Progress& at) {
  at.direction.note_change();
  at.value = at.E.evaluate(at.x);
  at.E.gradient(at.x, g);
  at.E.note_iterate(at.x);
  convergence.measure(g);
  ++at.report.values, ++at.report.gradients;
  at.report.lost_accuracy = 0;
}

// Returns the final status if the minimization ends at this iterate.
Minimizer::Impl::End Minimizer::Impl::test_convergence(Progress& at) {
  MinimizeReport& report = at.report;
  report.value = at.value.value;
  report.gradient_norm = std::sqrt(at.E.dot(g, g));
  convergence.describe(report);
  if (at.options.stop.requested()) return Status::interrupted;  // the iterate may be that of an incomplete search
  if (!std::isfinite(report.value) || !std::isfinite(report.gradient_norm)) return Status::undefined;
  if (at.last_direction || report.gradient_norm == 0) return Status::converged;
  if (!convergence.tests_direction() && report.reached <= report.threshold) {
    if (at.options.criterion == Criterion::scale) report.lost_accuracy = convergence.lost_accuracy(at.x);
    return report.lost_accuracy > 0 ? Status::round_off : Status::converged;
  }
  if (convergence.is_at_round_off(1)) return Status::round_off;
  if (report.iterations == at.options.max_iterations) return Status::iteration_limit;
  // The first iteration ignores the estimate, because a step without any direction would ignore the forces.
  if (at.options.stop.seconds_left() <= (report.iterations > 0 ? cost.at_least() : 0)) return Status::budget;
  return std::nullopt;
}

InnerAccuracy Minimizer::Impl::inner_accuracy(const Progress& at) const {
  InnerAccuracy accuracy = convergence.inner_accuracy(at.report);
  if (at.options.line_search.test != DecreaseTest::none) accuracy.value = at.value.value;
  return accuracy;
}

// Computes a direction and a step along it, falling back to more cautious directions.
Minimizer::Impl::End Minimizer::Impl::find_step(Progress& at, Iteration& iteration) {
  const Iterate iterate{at.E, at.x, g, inner_accuracy(at), at.options.stop.earlier_by(cost.to_finish())};
  const StopToken stop = at.options.stop.earlier_by(cost.gradient);
  const double begin = at.options.stop.now();
  for (;; ++iteration.fallbacks) {
    Status failure = Status::no_descent;
    const bool descends = find_direction(at, iterate, iteration);
    const double computed = at.options.stop.now();
    if (!iteration.direction.kept) {  // the next direction may need a new Hessian
      cost.direction = computed - begin;
      cost.stoppable = iteration.direction.stoppable_seconds;
    }
    if (descends) {
      const bool found = search_line(at, stop, iteration);
      cost.line_search = at.options.stop.now() - computed;
      if (found) return std::nullopt;
      if (at.last_direction) return Status::converged;
      convergence.note_hessian();
      if (convergence.is_at_round_off(Convergence::kRoundOffMargin)) return Status::round_off;
      failure = Status::stuck;
    }
    if (iteration.direction.stopped || stop.stopped()) return Status::budget;
    if (!at.direction.fall_back()) return failure;
  }
}

// Writes d. Returns false if it is not a descent direction.
bool Minimizer::Impl::find_direction(Progress& at, const Iterate& iterate, Iteration& iteration) {
  const bool found = at.direction.compute(iterate, d, iteration.direction);
  at.slope = found ? at.E.dot(g, d) : 0;
  iteration.decrement = -0.5 * at.slope;
  line.trials.clear();
  if (!(at.slope < 0)) return false;
  if (convergence.tests_direction()) {
    at.report.reached = convergence.size_of_direction(g, d);
    at.last_direction = at.lag.is_current() && convergence.is_near_minimum(at.report.reached, iteration.direction);
  }
  return true;
}

bool Minimizer::Impl::search_line(Progress& at, const StopToken& stop, Iteration& iteration) {
  Stopwatch stopwatch;
  at.step = backtrack({at.E, at.x, d, at.value, at.slope, stop, g}, at.options.line_search, line);
  iteration.trials += static_cast<int>(line.trials.size());
  iteration.gradients += at.step.gradients;
  iteration.line_search_seconds += stopwatch.lap();
  return at.step.alpha > 0;
}

// Afterwards, `line.trial` and `line.gradient` contain the start of the step.
void Minimizer::Impl::take_step(Progress& at, Iteration& iteration) {
  Stopwatch stopwatch;
  const double begin = at.options.stop.now();
  at.report.gradient_round_off = at.E.scales().gradient_round_off;  // uses the last Hessian
  convergence.note_hessian();
  if (at.direction.estimates_minimizer()) at.E.note_newton_step(at.x, d, at.step.alpha);
  std::swap_ranges(line.trial.begin(), line.trial.end(), at.x.begin());
  at.value = at.step.value;
  at.lag.note_step();
  if (!at.step.gradient_known) {
    at.E.gradient(at.x, line.gradient);
    ++iteration.gradients;
  }
  at.E.note_iterate(at.x);
  g.swap(line.gradient);
  convergence.measure(g);
  iteration.alpha = at.step.alpha;
  iteration.gradient_seconds = stopwatch.lap();
  if (!at.step.gradient_known) cost.gradient = at.options.stop.now() - begin;
}

Minimizer::Minimizer() : impl_(std::make_unique<Impl>()) {}
Minimizer::~Minimizer() = default;
Minimizer::Minimizer(Minimizer&&) noexcept = default;
Minimizer& Minimizer::operator=(Minimizer&&) noexcept = default;

std::span<const double> Minimizer::thresholds() const { return impl_->convergence.thresholds(); }

MinimizeReport Minimizer::minimize(Objective& E, SearchDirection& direction, InitialIterate initial,
                                   const MinimizeOptions& options, const IterationObserver& observe) {
  if (tests_direction(options.criterion) && !direction.estimates_minimizer())
    throw InvalidInput("criterion = '" + std::string(to_string(options.criterion)) +
                       "' needs the method newton or newton_cg: directions of " + std::string(direction.name()) +
                       " do not estimate the distance to the minimum (try 'scale')");
  const Evaluation value = initial.value ? *initial.value : E.evaluate(initial.x);
  Progress at{E, direction, initial.x, options, value};
  MinimizeReport report = impl_->minimize(at, observe);
  E.note_newton_step({}, {}, 0);
  if (!initial.value) ++report.values;
  return report;
}

}  // namespace aspic
