// Backward Euler, its linearization, the second-order backward difference formula, and the static limit.
#include <algorithm>
#include <cmath>

#include "contact/barrier.h"
#include "contact/friction.h"
#include "dynamics/advance_boundary.h"
#include "dynamics/implicit_stage.h"
#include "dynamics/lagged.h"
#include "dynamics/ledger.h"
#include "dynamics/runge_kutta.h"
#include "dynamics/runge_kutta_tables.h"

namespace aspic {
namespace {

// q_new = argmin 1/2 (q - q~)' M (q - q~) + h^2 V(q),  q~ = q_t + h qdot_t,  qdot_new = (q_new - q_t) / h
class BackwardEuler : public Integrator {
 public:
  explicit BackwardEuler(const IntegratorFacts& facts) : Integrator(facts) {}

  StepSolve advance(const StepTools& tools, State& end, StepForces& forces) override {
    StepSolve solve;
    forces.reset(tools.start.q.size());
    end = tools.start;
    stage_.a = end.q;
    stage_.b = end.qdot;
    acceleration_.resize(end.q.size());
    const StageOptions options{.beta = tools.h,
                               .time = tools.end_time,
                               .ahead = tools.h,
                               .tries_last_increment = false,  // equals the extrapolated guess
                               .once = facts().takes_one_iteration};
    if (stage_.solve(tools, options, {end.q, end.qdot, acceleration_}, solve, forces))
      tools.E.terms().end_internal(end.q, end.internal);
    end.time = tools.end_time;
    return solve;
  }

 private:
  ImplicitStage stage_;
  std::vector<double> acceleration_;
};

// Returns whether the integrator or friction adds energy in a step during or after contact, beyond round-off and the
// transients of rotations: whether numerical_loss or friction_loss of the ledger is negative.
bool gains_energy(const StepTools& tools, const State& end, const StepForces& forces) {
  constexpr double kTolerance = 1e-2;  // relative to the sum of the kinetic energies at start and end
  constexpr double kRoundOff = 1e-12;  // relative to the potential energies
  const State& start = tools.start;
  const Barrier& contact = *tools.model.contact;
  Energy::Context at_start, at_previous;
  at_start.time = tools.obstacle_start, at_previous.time = tools.previous->time;
  const double contact_before = contact.value(start.q, at_start);
  double loss = contact.obstacle_work(end.q, tools.obstacle_start, tools.end_time), magnitude = 0;
  bool touches = contact_before > 0 || contact.value(tools.previous->q, at_previous) > 0;
  for (const ActiveTerm& V : tools.E.terms().potential()) {
    const bool is_contact = &V.energy() == &contact;
    const double before = is_contact ? contact_before : V.value(start.q), after = V.value(end.q);
    touches = touches || (is_contact && after > 0);
    loss += before - after;
    magnitude += std::abs(before) + std::abs(after);
  }
  if (!touches) return false;
  double friction = 0;
  for (const ActiveTerm& D : tools.E.terms().damping())
    if (&D.energy() == tools.model.friction) friction += tools.model.friction->obstacle_work(end.q, D.context());
  std::vector<double> momentum(end.q.size());
  const double before = kinetic_energy(tools.model, start.qdot, momentum),
               after = kinetic_energy(tools.model, end.qdot, momentum);
  tools.model.mass->multiply(forces.acceleration, momentum);
  loss += before - after;
  for (size_t i = 0; i < end.q.size(); ++i) {
    const double moved = end.q[i] - start.q[i];
    loss += (momentum[i] + forces.gradient[i]) * moved;
    friction += forces.damping[i] * moved;
  }
  return -std::min(loss, friction) > kTolerance * (before + after) + kRoundOff * magnitude;
}

// q* = a + beta v*,  v* = b + beta acc(q*, v*) with a = (4 q_n - q_(n-1)) / 3, b = (4 v_n - v_(n-1)) / 3, beta = 2h/3
// [Hairer 1996, section V.1]. The first step is one of TR-BDF2, which has the same order, is also L-stable and, like
// BDF2, exact for constant acceleration. With contact it is one of backward Euler: TR-BDF2 begins with the forces at
// the start, where friction of bodies at rest has no direction. Extrapolation of velocities across an impact repeats
// half of it: a rigid body may rebound 1.25 times as fast. Therefore, steps that fail or, in contact, would gain
// energy are taken again with backward Euler.
class Bdf2 : public Integrator {
 public:
  Bdf2()
      : Integrator(
            {.name = "bdf2",
             .tex =
                 R"tex(\begin{gathered} v_{i+1} = \tfrac13 (4 v_i - v_{i-1}) + \tfrac23 h\, a_{i+1} \\ q_{i+1} = \tfrac13 (4 q_i - q_{i-1}) + \tfrac23 h\, v_{i+1} \end{gathered})tex",
             .order = 2,
             .is_multistep = true}) {}
  void set_pin_velocity(const Pins& pins, double h, State& state) const override {
    start_->set_pin_velocity(pins, h, state);
  }

  StepSolve advance(const StepTools& tools, State& end, StepForces& forces) override {
    if (!tools.previous && !tools.model.contact) return start_->advance(tools, end, forces);
    path_.sample(tools.pins, tools.start.time, tools.end_time, pin_path_points(facts().order));
    StepSolve solve;
    const bool is_solved = take(tools, tools.previous, end, forces, solve);
    const bool has_time = solve.work.status != Status::interrupted && solve.work.status != Status::budget;
    const bool may_repeat = tools.previous && tools.model.contact && has_time;
    if (may_repeat && (!is_solved || gains_energy(tools, end, forces))) {
      solve.work.status = Status::converged;
      take(tools, nullptr, end, forces, solve);
    }
    return solve;
  }

 private:
  // Writes the end of the step: of BDF2, or without the start of the previous step of backward Euler. Returns false if
  // the step has failed.
  bool take(const StepTools& tools, const State* previous, State& end, StepForces& forces, StepSolve& solve) {
    const State &now = tools.start, &last = previous ? *previous : now;
    const size_t n = now.q.size();
    for (auto* v : {&stage_.a, &stage_.b, &acceleration_}) v->resize(n);
    for (size_t i = 0; i < n; ++i) {
      stage_.a[i] = now.q[i] + (now.q[i] - last.q[i]) / 3;
      stage_.b[i] = now.qdot[i] + (now.qdot[i] - last.qdot[i]) / 3;
    }
    forces.reset(n);
    end = now;
    const StageOptions options{.beta = previous ? 2 * tools.h / 3 : tools.h,
                               .time = tools.end_time,
                               .ahead = tools.h,
                               .previous = previous,
                               .path = &path_};
    const bool is_solved = stage_.solve(tools, options, {end.q, end.qdot, acceleration_}, solve, forces);
    end.time = tools.end_time;
    return is_solved;
  }

  std::unique_ptr<Integrator> start_ = make_runge_kutta(kTrBdf2);
  ImplicitStage stage_;
  PinPath path_;
  std::vector<double> acceleration_;
};

// q_new = argmin V(q) + D(q), where D contains only terms with internal variables
class QuasiStatic : public Integrator {
 public:
  QuasiStatic()
      : Integrator({.name = "quasi_static",
                    .tex = R"tex(q_{i+1} = \operatorname{argmin}_q V(q), \quad v_{i+1} = 0)tex",
                    .order = 0}) {}

  StepSolve advance(const StepTools& tools, State& end, StepForces& forces) override {
    const State& start = tools.start;
    StepSolve solve;
    forces.reset(start.q.size());
    end = start;
    const StepContext context{start.q, 0, tools.end_time, {}, tools.obstacle_start};
    tools.E.at(
        {.predicted = start.q, .inertia = 0, .context = context, .internal = start.internal, .duration = tools.h});
    MinimizeReport guessing;
    const Guess guess = guesser_.guess(tools, tools.guess, {start.q, start.qdot, 0, tools.end_time}, end.q, guessing);
    solve.guess = guess.used;
    if (solve.add(minimize_lagged(tools, tools.options, {end.q, guess.value}, solve)))
      tools.E.terms().end_internal(end.q, end.internal);
    add_work(guessing, solve.work);
    std::fill(end.qdot.begin(), end.qdot.end(), 0.0);
    forces.add(tools.E, 1, end.q, {}, solve.work);
    forces.add_bounds(tools, ResidualBound::threshold, 1, end.q);
    end.time = tools.end_time;
    return solve;
  }

 private:
  Guesser guesser_;
};

}  // namespace

std::unique_ptr<Integrator> make_backward_euler() {
  return std::make_unique<BackwardEuler>(IntegratorFacts{
      .name = "backward_euler",
      .tex = R"tex(\begin{gathered} v_{i+1} = v_i + h\, a_{i+1} \\ q_{i+1} = q_i + h\, v_{i+1} \end{gathered})tex",
      .is_backward_euler = true});
}
// One Newton iteration from the current state, without line search [Baraff 1998].
std::unique_ptr<Integrator> make_linearly_implicit_euler() {
  return std::make_unique<BackwardEuler>(IntegratorFacts{
      .name = "linearly_implicit_euler",
      .tex =
          R"tex(\begin{gathered} \left(M + h^2 \frac{\partial^2 V}{\partial q^2}(q_i)\right) v_{i+1} = M v_i - h \frac{\partial V}{\partial q}(q_i) \\ q_{i+1} = q_i + h\, v_{i+1} \end{gathered})tex",
      .takes_one_iteration = true,
      .is_backward_euler = true});
}
std::unique_ptr<Integrator> make_bdf2() { return std::make_unique<Bdf2>(); }
std::unique_ptr<Integrator> make_quasi_static() { return std::make_unique<QuasiStatic>(); }

}  // namespace aspic
