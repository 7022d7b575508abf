// Classical forward Euler, and symplectic Euler, which the lecture's slide prints as "Forward Euler".
#include <algorithm>
#include <cmath>

#include "dynamics/acceleration.h"

namespace aspic {
namespace {

class ExplicitEuler : public Integrator {
 public:
  using Integrator::Integrator;

  StepSolve advance(const StepTools& tools, State& end, StepForces& forces) override {
    const State& start = tools.start;
    const double h = tools.h;
    forces.reset(start.q.size());
    end = start;
    for (auto* v : {&pin_velocity_, &scratch_}) v->assign(start.q.size(), 0.0);
    acceleration_.assign(start.q.size(), 0.0);
    set_pin_acceleration(tools, end);
    MinimizeReport report;
    report.iterations = 1;
    const MotionPoint at{start.time, end.q, end.qdot, DampingDifference::forward, 1};
    const bool solved = force_.solve(tools, at, acceleration_, forces, report);
    update(h, acceleration_, end);
    end.time = tools.end_time;
    tools.pins.place(end.time, end.q);

    const bool finite = std::all_of(end.q.begin(), end.q.end(), [](double x) { return std::isfinite(x); });
    report.status = finite && solved ? Status::converged : Status::undefined;
    StepSolve solve;
    solve.add(report);
    return solve;
  }

 protected:
  virtual bool moves_with_old_velocity() const = 0;
  virtual void update(double h, std::span<const double> acceleration, State& state) const = 0;

 private:
  // Sets the velocities with which pinned vertices reach their prescribed positions: those of this step, or those of
  // the next step if the scheme moves with old velocities.
  void set_pin_acceleration(const StepTools& tools, State& state) {
    const double h = tools.h;
    const auto place_velocity = [&](double from, double to) {
      tools.pins.place(to, pin_velocity_);
      tools.pins.place(from, scratch_);
      for (size_t i = 0; i < scratch_.size(); ++i) pin_velocity_[i] = (pin_velocity_[i] - scratch_[i]) / h;
    };
    if (moves_with_old_velocity()) {
      place_velocity(state.time, tools.end_time);
      tools.pins.copy_held(pin_velocity_, state.qdot);
      place_velocity(tools.end_time, tools.end_time + h);
    } else {
      place_velocity(state.time, tools.end_time);
    }
    for (size_t i = 0; i < scratch_.size(); ++i) pin_velocity_[i] = (pin_velocity_[i] - state.qdot[i]) / h;
    tools.pins.copy_held(pin_velocity_, acceleration_);
  }

  Acceleration force_;
  std::vector<double> pin_velocity_, acceleration_, scratch_;
};

// qdot_new = qdot + h a(q),  q_new = q + h qdot_new
class SymplecticEuler : public ExplicitEuler {
 public:
  SymplecticEuler()
      : ExplicitEuler(
            {.name = "symplectic_euler",
             .tex = R"tex(\begin{gathered} v_{i+1} = v_i + h\, a_i \\ q_{i+1} = q_i + h\, v_{i+1} \end{gathered})tex",
             .is_implicit = false}) {}

 protected:
  bool moves_with_old_velocity() const override { return false; }
  void update(double h, std::span<const double> acceleration, State& state) const override {
    for (size_t i = 0; i < state.q.size(); ++i) {
      state.qdot[i] += h * acceleration[i];
      state.q[i] += h * state.qdot[i];
    }
  }
};

// q_new = q + h qdot,  qdot_new = qdot + h a(q)
class ForwardEuler : public ExplicitEuler {
 public:
  ForwardEuler()
      : ExplicitEuler(
            {.name = "forward_euler",
             .tex = R"tex(\begin{gathered} q_{i+1} = q_i + h\, v_i \\ v_{i+1} = v_i + h\, a_i \end{gathered})tex",
             .is_implicit = false,
             .gains_energy = true}) {}

 protected:
  bool moves_with_old_velocity() const override { return true; }
  void update(double h, std::span<const double> acceleration, State& state) const override {
    for (size_t i = 0; i < state.q.size(); ++i) {
      state.q[i] += h * state.qdot[i];
      state.qdot[i] += h * acceleration[i];
    }
  }
};

}  // namespace

std::unique_ptr<Integrator> make_symplectic_euler() { return std::make_unique<SymplecticEuler>(); }
std::unique_ptr<Integrator> make_forward_euler() { return std::make_unique<ForwardEuler>(); }

}  // namespace aspic
