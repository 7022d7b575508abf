#include "dynamics/ledger.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

double total(const std::vector<Energy*>& terms, std::span<const double> x) {
  double V = 0;
  for (const Energy* term : terms) V += term->value(x);
  return V;
}

}  // namespace

double kinetic_energy(const MassMatrix& mass, std::span<const double> qdot, std::span<double> momentum) {
  mass.multiply(qdot, momentum);
  double T = 0;
  for (size_t i = 0; i < qdot.size(); ++i) T += 0.5 * qdot[i] * momentum[i];
  return T;
}

void Ledger::open(const StepTools& tools, const State& state) {
  before_ = state;
  momentum_.resize(state.qdot.size());
  kinetic_ = kinetic_energy(*tools.model.mass, state.qdot, momentum_);
  potential_ = total(tools.E.potential(), state.q);
}

void Ledger::targets_moved(const StepTools& tools, const State& state) {
  target_work_ = total(tools.E.potential(), state.q) - potential_;
}

void Ledger::note_worst_vertex(const Pins& pins, StepReport& report) const {
  double most = 0;
  for (size_t i = 0; i + 2 < residual_.size(); i += 3) {
    const double size = std::hypot(residual_[i], residual_[i + 1], residual_[i + 2]);
    const int vertex = static_cast<int>(i / 3);
    if (size > most && !pins.holds(vertex)) most = size, report.worst_vertex = vertex;
  }
  report.worst_residual = most;
}

void Ledger::close(const StepTools& tools, const Integrator& integrator, double h, const State& state,
                   StepReport& report) {
  const size_t n = state.q.size();
  for (auto* v : {&gradient_, &damping_, &dv_, &Mdv_, &at_, &residual_}) v->assign(n, 0.0);

  // Where the forces of the step act.
  const bool implicit = integrator.is_implicit();
  const std::vector<double>& x = implicit ? state.q : before_.q;
  for (size_t i = 0; i < n; ++i) at_[i] = implicit ? state.q[i] : before_.q[i] + h * before_.qdot[i];
  for (const Energy* V : tools.E.potential()) V->add_gradient(x, 1, gradient_);
  for (const Energy* D : tools.E.damping()) D->add_gradient(at_, 1, damping_);
  if (!integrator.is_static()) {
    for (size_t i = 0; i < n; ++i) dv_[i] = state.qdot[i] - before_.qdot[i];
    tools.model.mass->multiply(dv_, Mdv_);
  }

  double gradient_work = 0, residual_squared = 0, reaction_work = 0, velocity_jump = 0;
  report.damping_loss = report.residual_work = 0;
  for (size_t i = 0; i < n; ++i) {
    const double dx = state.q[i] - before_.q[i];
    const double r = residual_[i] = Mdv_[i] / h + gradient_[i] + damping_[i];
    const bool pinned = tools.pins.holds(static_cast<int>(i / 3));
    (pinned ? reaction_work : report.residual_work) += r * dx;
    if (!pinned) residual_squared += r * r;
    gradient_work += gradient_[i] * dx;
    report.damping_loss += damping_[i] * dx;
    velocity_jump += dv_[i] * Mdv_[i];
  }

  report.potential.clear();
  report.potential.reserve(tools.E.potential().size());
  report.potential_total = 0;
  for (const Energy* V : tools.E.potential()) report.potential.push_back(V->value(state.q));
  for (const double V : report.potential) report.potential_total += V;
  report.kinetic = kinetic_energy(*tools.model.mass, state.qdot, momentum_);
  report.residual = std::sqrt(residual_squared);
  note_worst_vertex(tools.pins, report);
  report.pin_work = reaction_work + target_work_;
  const double s = integrator.displacement() == Displacement::old_velocity ? -1 : 1;
  report.numerical_loss = s / 2 * velocity_jump + gradient_work - (report.potential_total - potential_ - target_work_);
  report.ledger_error = (report.kinetic - kinetic_) + (report.potential_total - potential_) - report.pin_work +
                        report.damping_loss + report.numerical_loss - report.residual_work;
}

}  // namespace aspic
