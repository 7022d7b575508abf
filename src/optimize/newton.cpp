#include <algorithm>
#include <cmath>

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

// H d = -g, loosely while the minimum is far away and tightly near it, so that convergence stays superlinear
// [Eisenstat and Walker 1996].
bool Newton::compute(Objective& E, std::span<const double> x, std::span<const double> g, double gradient_ratio,
                     std::span<double> d, DirectionReport& report) {
  const double tolerance = std::clamp(std::sqrt(gradient_ratio), 1e-8, 0.1);
  if (solve(E.hessian(x, first_choice(definiteness_)), g, tolerance, d, report)) return true;
  if (definiteness_ != NewtonDefiniteness::on_demand) return false;
  report.projected = true;
  return solve(E.hessian(x, HessianKind::clamped), g, tolerance, d, report);
}

bool Newton::solve(const BlockSparse& H, std::span<const double> g, double tolerance, std::span<double> d,
                   DirectionReport& report) {
  ++report.hessians;
  if (analyzed_version_ != H.pattern->version) {
    solver_->analyze(*H.pattern);
    analyzed_version_ = H.pattern->version;
  }
  ++report.factorizations;
  if (!solver_->factorize(H)) return false;
  const SolveReport solved = solver_->solve(g, d, tolerance);
  report.linear_iterations += solved.iterations;
  if (!solved.ok || solved.indefinite) return false;
  for (double& di : d) di = -di;
  return true;
}

}  // namespace aspic
