#include "optimize/newton.h"

#include "base/stopwatch.h"

namespace aspic {
namespace {

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

Newton::Newton(std::unique_ptr<LinearSolver> solver, NewtonDefiniteness definiteness)
    : solver_(std::move(solver)), definiteness_(definiteness) {}

std::string Newton::description() const { return "newton, " + solver_->description(); }

void Newton::begin() { clamp_next_ = clamped_ = false; }

// H d = -g
bool Newton::compute(Objective& E, std::span<const double> x, std::span<const double> g, double forcing,
                     std::span<double> d, DirectionReport& report) {
  clamped_ = clamp_next_;
  clamp_next_ = false;
  if (!clamped_ && solve(E, x, first_choice(definiteness_), g, forcing, d, report)) return true;
  if (definiteness_ != NewtonDefiniteness::on_demand) return false;
  clamped_ = report.projected = true;
  return solve(E, x, Definiteness::clamped, g, forcing, d, report);
}

bool Newton::retreat() { return clamp_next_ = definiteness_ == NewtonDefiniteness::on_demand && !clamped_; }

bool Newton::solve(Objective& E, std::span<const double> x, Definiteness kind, std::span<const double> g,
                   double forcing, std::span<double> d, DirectionReport& report) {
  Stopwatch stopwatch;
  const BlockSparse& H = E.hessian(x, {kind});
  ++report.hessians;
  report.projected_elements += E.projected_elements();
  report.hessian_seconds += stopwatch.lap();
  if (analyzed_version_ != H.pattern->version) {
    solver_->analyze(*H.pattern);
    analyzed_version_ = H.pattern->version;
  }
  ++report.factorizations;
  const bool definite = solver_->factorize(H);
  report.factorize_seconds += stopwatch.lap();
  if (!definite) return false;
  const SolveReport solved = solver_->solve(g, d, forcing);
  report.linear_iterations += solved.iterations;
  report.solve_seconds += stopwatch.lap();
  if (!solved.ok || solved.indefinite) return false;
  for (double& di : d) di = -di;
  return true;
}

}  // namespace aspic
