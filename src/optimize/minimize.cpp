#include "optimize/minimize.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/stopwatch.h"

namespace aspic {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::round_off:
      return "round_off";
    case Status::budget:
      return "budget";
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
    case Status::unstable:
      return "unstable";
    case Status::inaccurate:
      return "inaccurate";
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
    case Criterion::decrement:
      return "decrement";
    case Criterion::velocity:
      return "velocity";
    case Criterion::acceleration:
      return "acceleration";
  }
  return "unknown";
}

std::vector<Criterion> all_criteria() {
  return {Criterion::scale,     Criterion::first_gradient, Criterion::absolute,
          Criterion::decrement, Criterion::velocity,       Criterion::acceleration};
}

// Where a minimisation is, and the sizes by which it is judged: read when they are fresh, because an observer may
// evaluate E elsewhere.
struct Minimizer::Progress {
  Objective& E;
  SearchDirection& direction;
  std::span<double> x;
  const MinimizeOptions& options;
  MinimizeReport report;
  HasParts& parts;
  Evaluation value;
  double slope = 0;             // g.d
  LineSearchResult step;        // the last one
  bool last_direction = false;  // the criterion holds for it
  bool is_modified = false;     // the Hessian behind the last direction

  bool judges_direction() const { return aspic::judges_direction(options.criterion); }
};

namespace {

double threshold(const Objective& E, const MinimizeOptions& options, double scale, double first_gradient_norm) {
  switch (options.criterion) {
    case Criterion::scale:
      return options.tolerance * scale;
    case Criterion::first_gradient:
      return options.tolerance * first_gradient_norm;
    case Criterion::absolute:
      return options.tolerance * E.scales().gradient_unit;
    default:
      return options.tolerance;
  }
}

double largest_displacement(std::span<const double> d) {
  double largest = 0;
  for (size_t i = 0; i + 2 < d.size(); i += 3)
    largest = std::max(largest, d[i] * d[i] + d[i + 1] * d[i + 1] + d[i + 2] * d[i + 2]);
  return std::sqrt(largest);
}

// What a criterion that looks at the direction sees of it.
double direction_size(HasParts& E, const MinimizeOptions& options, std::span<const double> g,
                      std::span<const double> d) {
  switch (options.criterion) {
    case Criterion::velocity:
      return largest_displacement(d) / options.h;
    case Criterion::acceleration:
      return largest_displacement(d) / (options.h * options.h);
    default:
      return E.relative_decrement(g, d);
  }
}

// A line search that fails this close to the round-off of the gradient has nothing left to find.
constexpr double kRoundOffMargin = 100;

bool is_round_off(double gradient_norm, double scale, double round_off, double margin) {
  return std::isfinite(round_off) && gradient_norm <= margin * round_off && gradient_norm <= kResolved * scale;
}

void add(const Iteration& iteration, MinimizeReport& report) {
  const DirectionReport& direction = iteration.direction;
  report.add(direction);
  report.values += iteration.trials;
  report.trials += iteration.trials;
  report.gradients += iteration.gradients;
  report.projected_hessians += direction.projected;
  report.projected_elements += direction.projected_elements;
  report.retreats += iteration.retreats;
  report.decrement = iteration.decrement;
}

}  // namespace

// A direction and a step along it, by ever more cautious ways. False when there is none: the status says why.
bool Minimizer::find_step(Progress& at, Iteration& iteration) {
  Objective& E = at.E;
  SearchDirection& direction = at.direction;
  const MinimizeOptions& options = at.options;
  MinimizeReport& report = at.report;
  InnerAccuracy accuracy = inner_accuracy(at);
  if (options.line_search.test != DecreaseTest::none) accuracy.value = at.value.value;
  LineSearchOptions line_search = options.line_search;
  line_search.deadline = options.deadline.earlier_by(cost_.gradient);
  const double begin = options.deadline.now();
  for (;; ++iteration.retreats) {
    const bool found = direction.compute(E, at.x, g_, accuracy, d_, iteration.direction);
    const double computed = options.deadline.now();
    if (!iteration.direction.kept) {  // the next one may have to make its Hessian
      cost_.direction = computed - begin;
      cost_.stoppable = iteration.direction.stoppable_seconds;
    }
    at.slope = found ? E.dot(g_, d_) : 0;
    iteration.decrement = -0.5 * at.slope;
    report.status = Status::no_descent;
    trials_.clear();
    if (at.slope < 0) {
      if (at.judges_direction()) {
        report.reached = direction_size(at.parts, options, g_, d_);
        const DirectionReport& made = iteration.direction;
        if (!made.kept) at.is_modified = made.projected_elements > 0;
        at.last_direction = is_near_minimum(at, made);
      }
      Stopwatch stopwatch;
      at.step = backtrack(E, at.x, d_, at.value, at.slope, line_search, trial_, trial_gradient_, trials_);
      iteration.trials += static_cast<int>(trials_.size());
      iteration.gradients += at.step.gradients;
      iteration.line_search_seconds += stopwatch.lap();
      cost_.line_search = options.deadline.now() - computed;
      if (at.step.alpha > 0) return true;
      report.status = Status::stuck;
      if (at.last_direction) return report.status = Status::converged, false;
      for (size_t k = 0; k < parts_.size(); ++k) round_offs_[k] = at.parts.part_round_off(static_cast<int>(k));
      if (is_at_round_off(at, kRoundOffMargin)) return report.status = Status::round_off, false;
    }
    if (iteration.direction.stopped || line_search.deadline.has_passed()) return report.status = Status::budget, false;
    if (!direction.retreat()) return false;
  }
}

// Afterwards `trial_` and `trial_gradient_` hold where the step began.
void Minimizer::take_step(Progress& at, Iteration& iteration) {
  Stopwatch stopwatch;
  const double begin = at.options.deadline.now();
  at.report.gradient_round_off = at.E.scales().gradient_round_off;  // of the last Hessian
  for (size_t k = 0; k < parts_.size(); ++k) round_offs_[k] = at.parts.part_round_off(static_cast<int>(k));
  std::swap_ranges(trial_.begin(), trial_.end(), at.x.begin());
  at.value = at.step.value;
  if (!at.step.gradient_known) {
    at.E.gradient(at.x, trial_gradient_);
    ++iteration.gradients;
  }
  at.E.note_iterate(at.x);
  g_.swap(trial_gradient_);
  at.parts.measure_parts(g_, parts_);
  iteration.alpha = at.step.alpha;
  iteration.gradient_seconds = stopwatch.lap();
  if (!at.step.gradient_known) cost_.gradient = at.options.deadline.now() - begin;
}

// Where g_ belongs to the first iterate.
void Minimizer::begin_parts(HasParts& E) {
  const size_t count = E.part_count();
  parts_.resize(count);
  for (auto* v : {&first_norms_, &thresholds_, &round_offs_}) v->resize(count);
  E.measure_parts(g_, parts_);
  for (size_t k = 0; k < count; ++k) {
    first_norms_[k] = parts_[k].norm;
    round_offs_[k] = E.part_round_off(static_cast<int>(k));
  }
}

// The report shows the part that is farthest from its threshold.
void Minimizer::judge_parts(Progress& at) {
  double farthest = -1;
  for (size_t k = 0; k < parts_.size(); ++k) {
    const double norm = parts_[k].norm;
    thresholds_[k] = threshold(at.E, at.options, parts_[k].scale, first_norms_[k]);
    const double ratio = norm > 0 ? norm / thresholds_[k] : 0;
    if (ratio <= farthest) continue;
    farthest = ratio;
    at.report.threshold = thresholds_[k];
    if (!at.judges_direction()) at.report.reached = norm;
  }
}

// Near a saddle a short direction does not mean that a minimum is near. Nor does one of a modified Hessian, which
// shortens it: the gradient must then be small beside what it is made of.
bool Minimizer::is_near_minimum(const Progress& at, const DirectionReport& made) const {
  constexpr double kBalanced = 1e-6;
  if (made.projected || made.truncated || made.stopped || !(at.report.reached <= at.options.tolerance)) return false;
  return !at.is_modified || std::all_of(parts_.begin(), parts_.end(),
                                        [](const GradientPart& part) { return part.norm <= kBalanced * part.scale; });
}

// Linear solves see the whole of g, of which a part that has not converged may be a small share.
InnerAccuracy Minimizer::inner_accuracy(const Progress& at) const {
  constexpr double kFinestSolve = 1e-12;  // the most accurate one that is worth its iterations
  const MinimizeOptions& options = at.options;
  const double norm = at.report.gradient_norm;
  InnerAccuracy accuracy = {options.max_forcing, at.judges_direction() ? 0 : 0.5 * at.report.threshold / norm,
                            options.deadline.earlier_by(cost_.to_finish())};
  if (parts_.size() == 1) return accuracy;
  double smallest = norm;
  for (size_t k = 0; k < parts_.size(); ++k) {
    const bool has_converged = !at.judges_direction() && parts_[k].norm <= thresholds_[k];
    if (has_converged || parts_[k].norm <= round_offs_[k]) continue;
    smallest = std::min(smallest, parts_[k].norm);
    if (!at.judges_direction()) accuracy.enough = std::min(accuracy.enough, 0.5 * thresholds_[k] / norm);
  }
  accuracy.loosest = std::max(kFinestSolve, options.max_forcing * smallest / norm);
  return accuracy;
}

// Whether every part has converged or is at its round-off.
bool Minimizer::is_at_round_off(const Progress& at, double margin) const {
  for (size_t k = 0; k < parts_.size(); ++k) {
    const auto& [norm, scale] = parts_[k];
    const bool has_converged = !at.judges_direction() && norm <= thresholds_[k];
    if (!has_converged && !is_round_off(norm, scale, round_offs_[k], margin)) return false;
  }
  return true;
}

MinimizeReport Minimizer::minimize(Objective& E, SearchDirection& direction, std::span<double> x,
                                   const MinimizeOptions& options, const IterationObserver& observe) {
  MinimizeReport report = minimize(E, direction, x, E.evaluate(x), options, observe);
  ++report.values;
  return report;
}

MinimizeReport Minimizer::minimize(Objective& E, SearchDirection& direction, std::span<double> x,
                                   const Evaluation& value, const MinimizeOptions& options,
                                   const IterationObserver& observe) {
  if (judges_direction(options.criterion) && !direction.estimates_minimiser())
    throw InvalidInput("criterion = '" + std::string(to_string(options.criterion)) +
                       "' needs the method newton or newton_cg: directions of " + std::string(direction.name()) +
                       " do not tell how far the minimum is (try 'scale')");
  for (auto* v : {&g_, &d_, &trial_, &trial_gradient_}) v->resize(x.size());
  trials_.reserve(64);
  direction.begin();

  WholePart whole(E);
  auto* parts = dynamic_cast<HasParts*>(&E);
  Progress at{E, direction, x, options, {}, parts ? *parts : whole, value};
  MinimizeReport& report = at.report;
  E.gradient(x, g_);
  begin_parts(at.parts);
  report.gradients = 1;
  for (int i = 0;; ++i) {
    report.iterations = i;
    report.value = at.value.value;
    report.gradient_norm = std::sqrt(E.dot(g_, g_));
    if (i == 0) report.first_gradient_norm = report.gradient_norm;
    judge_parts(at);
    const auto ended = [&](Status status) { return report.status = status, report; };
    if (!std::isfinite(report.value) || !std::isfinite(report.gradient_norm)) return ended(Status::undefined);
    if (at.last_direction || report.gradient_norm == 0) return ended(Status::converged);
    if (!at.judges_direction() && report.reached <= report.threshold) {
      if (options.criterion == Criterion::scale) report.lost_accuracy = at.parts.lost_accuracy(x, parts_);
      return ended(report.lost_accuracy > 0 ? Status::round_off : Status::converged);
    }
    if (is_at_round_off(at, 1)) return ended(Status::round_off);
    if (i == options.max_iterations) return ended(Status::iteration_limit);
    // The first iteration is tried even if it may not fit: without any, no force would act.
    if (options.deadline.left() <= (i > 0 ? cost_.at_least() : 0)) return ended(Status::budget);

    LiveIteration iteration{{.index = i, .value = report.value, .gradient_norm = report.gradient_norm}, E};
    const bool found = find_step(at, iteration);
    if (found) take_step(at, iteration);
    add(iteration, report);
    iteration.gradients += iteration.direction.gradients;
    iteration.x = found ? trial_ : x;
    iteration.g = found ? trial_gradient_ : g_;
    iteration.d = d_, iteration.x_next = x, iteration.tried = trials_;
    const bool go_on = !observe || observe(iteration);
    if (!found) return report;
    if (!go_on) {
      report.iterations = i + 1;
      return ended(Status::interrupted);
    }
  }
}

}  // namespace aspic
