#include "dynamics/acceleration.h"

#include <algorithm>
#include <cmath>

#include "energy/wind.h"

namespace aspic {
namespace {

constexpr double kAccelerationTolerance = 1e-12;  // the mass matrix is well conditioned

}  // namespace

void Acceleration::add_damping(const StepTools& tools, const MotionPoint& at, double h, double scale) {
  for (size_t i = 0; i < at.q.size(); ++i) drift_[i] = at.q[i] + h * at.v[i];
  for (const ActiveTerm& D : tools.E.terms().damping())
    if (!dynamic_cast<const PressureRim*>(&D.energy()) && &D.energy() != tools.model.wind)
      D.add_gradient(drift_, scale, damping_);
}

// Wind acts on a sheet at rest, so central differences would lose it.
void Acceleration::add_wind(const StepTools& tools, const MotionPoint& at) {
  for (size_t i = 0; i < at.q.size(); ++i) drift_[i] = at.q[i] + tools.h * at.v[i];
  for (const ActiveTerm& D : tools.E.terms().damping())
    if (&D.energy() == tools.model.wind) D.add_gradient(drift_, 1, damping_);
}

bool Acceleration::solve(const StepTools& tools, const MotionPoint& at, std::span<double> acc, StepForces& forces,
                         Work& work) {
  const size_t n = at.q.size();
  for (auto* w : {&gradient_, &damping_, &drift_, &force_, &scratch_}) w->assign(n, 0.0);
  const StepContext context{at.q, tools.h, at.time};
  tools.E.terms().begin(context);
  for (const ActiveTerm& V : tools.E.terms().potential()) V.add_gradient(at.q, 1, gradient_);
  ++work.gradients;
  if (at.difference == DampingDifference::forward) {
    add_damping(tools, at, tools.h, 1);
  } else {
    add_damping(tools, at, tools.h, 0.5);
    add_damping(tools, at, -tools.h, -0.5);
  }
  if (tools.model.wind) add_wind(tools, at);
  std::fill(drift_.begin(), drift_.end(), 0.0);  // from here on the forces of rims, which do not depend on v
  tools.E.terms().add_rim_gradient(at.q, 1, drift_);
  for (size_t i = 0; i < n; ++i) damping_[i] += drift_[i];

  tools.pins.copy_held(acc, scratch_);
  std::copy(scratch_.begin(), scratch_.end(), acc.begin());
  tools.model.mass->multiply(acc, scratch_);
  for (size_t i = 0; i < n; ++i) force_[i] = -gradient_[i] - damping_[i] - scratch_[i];
  tools.pins.set_zero(force_);
  double squared = 0;
  for (const double f : force_) squared += f * f;
  round_off_ = kAccelerationTolerance * std::sqrt(squared);
  const SolveReport solved = solve_mass(tools, force_, scratch_);
  work.add(solved);
  tools.pins.set_zero(scratch_);
  for (size_t i = 0; i < n; ++i) {
    acc[i] += scratch_[i];
    forces.gradient[i] += at.weight * gradient_[i];
    forces.damping[i] += at.weight * damping_[i];
    forces.rims[i] += at.weight * drift_[i];
    forces.acceleration[i] += at.weight * acc[i];
  }
  return solved.ok;
}

SolveReport Acceleration::solve_mass(const StepTools& tools, std::span<const double> force, std::span<double> acc) {
  if (!solver_) {
    solver_ = make_linear_solver("auto");
    M_.emplace(tools.E.pattern());
    tools.model.mass->add_to(1, *M_);
    tools.pins.set_identity(*M_);
    solver_->analyze(tools.E.pattern());
    factorized_ = solver_->factorize(*M_);
  }
  return factorized_ ? solver_->solve(force, acc, kAccelerationTolerance) : SolveReport{};
}

}  // namespace aspic
