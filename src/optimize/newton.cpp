#include "optimize/newton.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/stopwatch.h"
#include "linalg/conjugate_gradient.h"

namespace aspic {
namespace {

constexpr int kAbsoluteSpan = 8;  // directions; twice as many after each further one that overshoots

Definiteness first_choice(NewtonDefiniteness definiteness) {
  switch (definiteness) {
    case NewtonDefiniteness::clamped:
      return Definiteness::clamped;
    case NewtonDefiniteness::absolute:
      return Definiteness::absolute;
    default:
      return Definiteness::exact;
  }
}

}  // namespace

std::string_view to_string(NewtonDefiniteness definiteness) {
  switch (definiteness) {
    case NewtonDefiniteness::exact:
      return "exact";
    case NewtonDefiniteness::clamped:
      return "clamped";
    case NewtonDefiniteness::absolute:
      return "absolute";
    case NewtonDefiniteness::on_demand:
      return "on_demand";
    case NewtonDefiniteness::progressive:
      return "progressive";
  }
  return "unknown";
}

std::vector<NewtonDefiniteness> all_definiteness() {
  return {NewtonDefiniteness::on_demand, NewtonDefiniteness::progressive, NewtonDefiniteness::clamped,
          NewtonDefiniteness::absolute, NewtonDefiniteness::exact};
}

Newton::Newton(std::unique_ptr<LinearSolver> solver, NewtonDefiniteness definiteness)
    : solver_(std::move(solver)), definiteness_(definiteness) {}

std::unique_ptr<Newton> make_newton_cg(NewtonDefiniteness definiteness) {
  auto direction = std::make_unique<Newton>(
      std::make_unique<ConjugateGradient>(std::make_unique<BlockJacobi>(BlockJacobi::Blocks::made_definite)),
      definiteness);
  direction->truncated_ = true;
  return direction;
}

std::string Newton::description() const {
  return std::string(name()) + ", definiteness " + std::string(to_string(definiteness_)) + ", " +
         solver_->description();
}

void Newton::begin() {
  cautious_next_ = clamped_ = false;
  absolute_left_ = 0;
  absolute_span_ = kAbsoluteSpan;
  is_new_ = true;
  kept_.drop();
  forcing_.begin();
  solver_->begin();
  progressive_.begin();
}

// H d = -g
bool Newton::compute(Objective& E, std::span<const double> x, std::span<const double> g, const InnerAccuracy& accuracy,
                     std::span<double> d, DirectionReport& report) {
  gradient_norm_ = std::sqrt(E.dot(g, g));
  const double forcing = forcing_.at(gradient_norm_, accuracy);
  const bool cautious = std::exchange(cautious_next_, false);
  is_first_ = std::exchange(is_new_, false);
  deadline_ = accuracy.deadline;
  solver_->set_deadline(deadline_);
  used_kept_ = kept_.serves(gradient_norm_, accuracy) && solve_with_kept(E, g, forcing, d, report);
  if (used_kept_) return true;
  kept_.drop();
  if (definiteness_ == NewtonDefiniteness::progressive) {
    // Relaxed only once a direction was of use: else a retreat would take back what it gains, and never end.
    cautious ? progressive_.tighten(g) : progressive_.relax();
    return solve_progressively(E, x, g, forcing, d, report);
  }
  clamped_ = cautious;
  if (!clamped_ && solve(E, x, {first_choice(definiteness_)}, g, forcing, d, report)) return true;
  if (definiteness_ != NewtonDefiniteness::on_demand || is_late(report)) return false;
  return solve_on_demand(E, x, accuracy.value, g, forcing, d, report);
}

// Where elements are inverted or far from their volume, negative eigenvalues are as large as positive ones. Clamped,
// they leave a direction that reaches too far; their absolute values hold it back [Chen2024Filtering]. Elsewhere those
// are too stiff.
bool Newton::solve_on_demand(Objective& E, std::span<const double> x, std::optional<double> value,
                             std::span<const double> g, double forcing, std::span<double> d, DirectionReport& report) {
  clamped_ = report.projected = true;
  if (absolute_left_ == 0) {
    if (!solve(E, x, {Definiteness::clamped}, g, forcing, d, report)) return false;
    if (!value || is_late(report) || !overshoots(E, x, *value, d, report)) return true;
    absolute_left_ = absolute_span_;
    absolute_span_ *= 2;
  }
  --absolute_left_;
  return solve(E, x, {Definiteness::absolute}, g, forcing, d, report);
}

// Whether E rises along the whole of d, or the part of it that terms of E allow.
bool Newton::overshoots(Objective& E, std::span<const double> x, double value, std::span<const double> d,
                        DirectionReport& report) {
  const double reach = std::min(1.0, E.max_step(x, d));
  ahead_.resize(x.size());
  for (size_t i = 0; i < x.size(); ++i) ahead_[i] = x[i] + reach * d[i];
  ++report.values;
  return !(E.value(ahead_) <= value);
}

bool Newton::retreat() {
  kept_.drop();
  if (used_kept_) return true;
  cautious_next_ = definiteness_ == NewtonDefiniteness::progressive
                       ? !progressive_.is_complete()
                       : definiteness_ == NewtonDefiniteness::on_demand && !clamped_;
  return cautious_next_;
}

bool Newton::solve_progressively(Objective& E, std::span<const double> x, std::span<const double> g, double forcing,
                                 std::span<double> d, DirectionReport& report) {
  for (;; progressive_.tighten(g)) {
    const Projection projection = progressive_.at(g);
    report.projected = report.projected || projection.kind != Definiteness::exact;
    if (solve(E, x, projection, g, forcing, d, report)) break;
    if (progressive_.is_complete() || is_late(report)) return false;
  }
  return true;
}

bool Newton::solve(Objective& E, std::span<const double> x, const Projection& projection, std::span<const double> g,
                   double forcing, std::span<double> d, DirectionReport& report) {
  Stopwatch stopwatch;
  const BlockSparse& H = E.hessian(x, projection);
  ++report.hessians;
  report.kept = false;
  report.projected_elements += E.projected_elements();
  report.hessian_seconds += stopwatch.lap();
  if (is_late(report)) return false;
  if (analyzed_version_ != H.pattern->version) {
    solver_->analyze(*H.pattern);
    analyzed_version_ = H.pattern->version;
  }
  ++report.factorizations;
  const bool definite = solver_->factorize(H);
  report.factorize_seconds += stopwatch.lap();
  if (!definite) return false;
  if (!solve_factorized(g, forcing, d, report)) return false;
  if (projection.kind == Definiteness::exact && !report.truncated && !report.stopped) kept_.keep(E, H, x);
  return true;
}

// The factorisation, or the preconditioner, is kept as well.
bool Newton::solve_with_kept(Objective& E, std::span<const double> g, double forcing, std::span<double> d,
                             DirectionReport& report) {
  kept_.restore(E);
  return report.kept = solve_factorized(g, forcing, d, report);
}

bool Newton::solve_factorized(std::span<const double> g, double forcing, std::span<double> d, DirectionReport& report) {
  Stopwatch stopwatch;
  const double begin = deadline_.now();
  const SolveReport solved = solver_->solve(g, d, forcing);
  if (solved.iterations > 0) report.stoppable_seconds += deadline_.now() - begin;
  report.stopped = report.stopped || solved.stopped;
  report.add(solved);
  report.solve_seconds += stopwatch.lap();
  if (solved.indefinite ? !truncated_ : !solved.ok && !solved.stopped) return false;
  report.truncated = report.truncated || solved.indefinite;
  kept_.note_solve(gradient_norm_, solved.relative_residual);
  for (double& di : d) di = -di;
  return true;
}

}  // namespace aspic
