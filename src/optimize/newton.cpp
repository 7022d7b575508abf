#include "optimize/search_direction.h"

namespace aspic {
namespace {

HessianKind first_choice(NewtonDefiniteness definiteness) {
  switch (definiteness) {
    case NewtonDefiniteness::clamped:
      return HessianKind::clamped;
    case NewtonDefiniteness::absolute:
      return HessianKind::absolute;
    default:
      return HessianKind::exact;
  }
}

}  // namespace

Newton::Newton(std::unique_ptr<LinearSolver> solver, NewtonDefiniteness definiteness)
    : solver_(std::move(solver)), definiteness_(definiteness) {}

std::string Newton::description() const { return "newton, " + solver_->description(); }

// H d = -g
bool Newton::compute(Objective& E, std::span<const double> x, std::span<const double> g, double forcing,
                     std::span<double> d, DirectionReport& report) {
  if (solve(E.hessian(x, first_choice(definiteness_)), g, forcing, d, report)) return true;
  if (definiteness_ != NewtonDefiniteness::on_demand) return false;
  report.projected = true;
  return solve(E.hessian(x, HessianKind::clamped), g, forcing, d, report);
}

bool Newton::solve(const BlockSparse& H, std::span<const double> g, double forcing, std::span<double> d,
                   DirectionReport& report) {
  ++report.hessians;
  if (analyzed_version_ != H.pattern->version) {
    solver_->analyze(*H.pattern);
    analyzed_version_ = H.pattern->version;
  }
  ++report.factorizations;
  if (!solver_->factorize(H)) return false;
  const SolveReport solved = solver_->solve(g, d, forcing);
  report.linear_iterations += solved.iterations;
  if (!solved.ok || solved.indefinite) return false;
  for (double& di : d) di = -di;
  return true;
}

}  // namespace aspic
