#include "optimize/newton.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/stopwatch.h"
#include "linalg/conjugate_gradient.h"

namespace aspic {
namespace {

constexpr int kAbsoluteSpan = 8;  // directions; twice as many after each further one that overshoots
constexpr int kPatience = 2;      // directions of modified Hessians in a row before truncated ones are tried

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
  modified_in_a_row_ = 0;
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
  semidefinite_solver_.set_deadline(deadline_);
  used_kept_ = kept_.serves(gradient_norm_, accuracy) && solve_with_kept(E, g, forcing, d, report);
  if (used_kept_) return true;
  kept_.drop();
  if (definiteness_ == NewtonDefiniteness::progressive) {
    // Relaxed only once a direction was of use: else a retreat would take back what it gains, and never end.
    cautious ? progressive_.tighten(g) : progressive_.relax();
    return solve_progressively(E, x, g, forcing, d, report);
  }
  exact_ = nullptr;
  clamped_ = cautious;
  if (!clamped_ && solve(E, x, {first_choice(definiteness_)}, g, forcing, d, report)) {
    modified_in_a_row_ = 0;
    return true;
  }
  if (definiteness_ != NewtonDefiniteness::on_demand || is_late(report)) return false;
  return solve_on_demand({E, x, g, accuracy.value}, forcing, d, report);
}

// Modified Hessians are too stiff near a saddle: the iterates leave it at a creep. After some of them in a row a
// truncated direction of the exact Hessian is used where it gains as much as the last step did.
bool Newton::solve_on_demand(const Place& at, double forcing, std::span<double> d, DirectionReport& report) {
  const double gained = at.value ? last_value_ - *at.value : 0;
  if (at.value) last_value_ = *at.value;
  const bool creeps = at.value && !clamped_ && modified_in_a_row_ >= kPatience;
  ++modified_in_a_row_;
  if (creeps && solve_truncated(at, gained, forcing, d, report)) return true;
  if (is_late(report)) return false;
  clamped_ = report.projected = true;
  return solve_modified(at, forcing, d, report);
}

bool Newton::solve_truncated(const Place& at, double gained, double forcing, std::span<double> d,
                             DirectionReport& report) {
  if (!exact_ || !solve_semidefinite(*exact_, at.g, forcing, d, report)) return false;
  const bool is_better = *at.value - lengthen(at, d, report) >= gained;
  report.truncated = is_better;
  return is_better;
}

// Where elements are inverted or far from their volume, negative eigenvalues are as large as positive ones. Clamped,
// they leave a direction that reaches too far; their absolute values hold it back [Chen2024Filtering]. Elsewhere those
// are too stiff.
bool Newton::solve_modified(const Place& at, double forcing, std::span<double> d, DirectionReport& report) {
  if (absolute_left_ == 0) {
    if (!solve(at.E, at.x, {Definiteness::clamped}, at.g, forcing, d, report)) return false;
    if (!at.value || is_late(report) || lengthen(at, d, report) <= *at.value) return true;
    absolute_left_ = absolute_span_;
    absolute_span_ *= 2;
  }
  --absolute_left_;
  if (!solve(at.E, at.x, {Definiteness::absolute}, at.g, forcing, d, report)) return false;
  if (at.value && !is_late(report)) lengthen(at, d, report);
  return true;
}

// Doubles d for as long as the parabola through E at its start and its end has its minimum beyond twice d, and E falls.
// Returns E at its end, or where terms of E forbid that, at the end of the part they allow.
double Newton::lengthen(const Place& at, std::span<double> d, DirectionReport& report) {
  const double reach = at.E.max_step(at.x, d);
  double end = value_ahead(at, std::min(1.0, reach), d, report);
  double slope = at.E.dot(at.g, d), size = 0;
  for (const double di : d) size = std::max(size, std::abs(di));
  for (double length = 2; 4 * (end - *at.value - slope) < -slope; length *= 2, slope *= 2) {
    if (reach < length || length * size > at.E.scales().x) break;
    const double further = value_ahead(at, 2, d, report);
    if (!(further < end)) break;
    for (double& di : d) di *= 2;
    end = further;
  }
  return end;
}

// E at x + alpha d
double Newton::value_ahead(const Place& at, double alpha, std::span<const double> d, DirectionReport& report) {
  ahead_.resize(at.x.size());
  for (size_t i = 0; i < ahead_.size(); ++i) ahead_[i] = at.x[i] + alpha * d[i];
  ++report.values;
  return at.E.value(ahead_);
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
  const bool is_definite = solver_->factorize(H);
  report.factorize_seconds += stopwatch.lap();
  const bool is_exact = projection.kind == Definiteness::exact;
  exact_ = is_exact ? &H : nullptr;
  if (is_definite && solve_factorized(g, forcing, d, report)) {
    if (is_exact && !report.truncated && !report.stopped) kept_.keep(E, H, x);
    return true;
  }
  const bool is_modified = !is_exact && projection.vertices.empty();
  return is_modified && !truncated_ && !is_late(report) && solve_semidefinite(H, g, forcing, d, report);
}

// By conjugate gradients, which bear directions that H does not resist, such as rotations about a single pinned vertex.
// Where they meet negative curvature, d is as far as they came.
bool Newton::solve_semidefinite(const BlockSparse& H, std::span<const double> g, double forcing, std::span<double> d,
                                DirectionReport& report) {
  Stopwatch stopwatch;
  if (semidefinite_version_ != H.pattern->version) {
    semidefinite_solver_.analyze(*H.pattern);
    semidefinite_version_ = H.pattern->version;
  }
  if (!semidefinite_solver_.factorize(H)) return false;
  const SolveReport solved = semidefinite_solver_.solve(g, d, forcing);
  report.stopped = report.stopped || solved.stopped;
  report.add(solved);
  report.solve_seconds += stopwatch.lap();
  report.truncated = report.truncated || solved.indefinite;
  for (double& di : d) di = -di;
  return solved.ok || solved.indefinite || solved.stopped;
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
