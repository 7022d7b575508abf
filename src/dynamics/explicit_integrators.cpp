// Classical forward Euler, and symplectic Euler: the scheme that the lecture's slide prints as "Forward Euler".
#include <algorithm>
#include <cmath>
#include <optional>

#include "dynamics/integrator.h"

namespace aspic {
namespace {

constexpr double kSolveTolerance = 1e-12;  // the mass matrix is well conditioned

class ExplicitIntegrator : public Integrator {
 public:
  bool is_implicit() const override { return false; }

  MinimizeReport advance(const StepTools& tools, double h, State& state) override {
    for (auto* v : {&pin_velocity_, &acceleration_, &force_, &drift_, &scratch_}) v->resize(state.q.size());
    place_pin_velocity(tools, h, state.time);
    const SolveReport solved = solve_motion(tools, h, state);
    update(h, acceleration_, state);
    state.time = tools.end_time;
    tools.pins.place(state.time, state.q);

    MinimizeReport report;
    report.iterations = 1;
    report.linear_iterations = solved.iterations;
    const bool finite = std::all_of(state.q.begin(), state.q.end(), [](double x) { return std::isfinite(x); });
    report.status = finite && solved.ok ? Status::converged : Status::undefined;
    return report;
  }

 protected:
  virtual void update(double h, std::span<const double> acceleration, State& state) const = 0;

 private:
  // Velocities with which pinned vertices arrive where they are prescribed.
  void place_pin_velocity(const StepTools& tools, double h, double time) {
    const bool ahead = displacement() == Displacement::old_velocity;  // this velocity moves the next step
    tools.pins.place(ahead ? tools.end_time + h : tools.end_time, pin_velocity_);
    tools.pins.place(ahead ? tools.end_time : time, scratch_);
    for (size_t i = 0; i < scratch_.size(); ++i) pin_velocity_[i] = (pin_velocity_[i] - scratch_[i]) / h;
  }

  // M a = -dV/dq - C qdot, with the accelerations of pinned vertices known.
  SolveReport solve_motion(const StepTools& tools, double h, const State& state) {
    const size_t n = state.q.size();
    for (size_t i = 0; i < n; ++i) drift_[i] = state.q[i] + h * state.qdot[i];
    std::fill(force_.begin(), force_.end(), 0.0);
    for (const Energy* V : tools.E.potential()) V->add_gradient(state.q, -1, force_);
    for (const Energy* D : tools.E.damping()) D->add_gradient(drift_, -1, force_);
    for (size_t i = 0; i < n; ++i) {
      const bool pinned = tools.pins.holds(static_cast<int>(i / 3));
      acceleration_[i] = pinned ? (pin_velocity_[i] - state.qdot[i]) / h : 0;
    }
    tools.model.mass->multiply(acceleration_, scratch_);
    for (size_t i = 0; i < n; ++i) force_[i] -= scratch_[i];
    tools.pins.set_zero(force_);
    const SolveReport solved = solve_mass(tools, force_, scratch_);
    tools.pins.set_zero(scratch_);
    for (size_t i = 0; i < n; ++i) acceleration_[i] += scratch_[i];
    return solved;
  }

  SolveReport solve_mass(const StepTools& tools, std::span<const double> force, std::span<double> a) {
    if (!solver_) {
      solver_ = make_linear_solver("auto");
      M_.emplace(tools.E.pattern());
      tools.model.mass->add_to(1, *M_);
      tools.pins.set_identity(*M_);
      solver_->analyze(tools.E.pattern());
      factorized_ = solver_->factorize(*M_);
    }
    return factorized_ ? solver_->solve(force, a, kSolveTolerance) : SolveReport{};
  }

  std::unique_ptr<LinearSolver> solver_;
  std::optional<BlockSparse> M_;
  std::vector<double> pin_velocity_, acceleration_, force_, drift_, scratch_;
  bool factorized_ = false;
};

// qdot_new = qdot + h a(q),  q_new = q + h qdot_new
class SymplecticEuler : public ExplicitIntegrator {
 public:
  std::string_view name() const override { return "symplectic_euler"; }
  Displacement displacement() const override { return Displacement::new_velocity; }

 protected:
  void update(double h, std::span<const double> acceleration, State& state) const override {
    for (size_t i = 0; i < state.q.size(); ++i) {
      state.qdot[i] += h * acceleration[i];
      state.q[i] += h * state.qdot[i];
    }
  }
};

// q_new = q + h qdot,  qdot_new = qdot + h a(q)
class ForwardEuler : public ExplicitIntegrator {
 public:
  std::string_view name() const override { return "forward_euler"; }
  Displacement displacement() const override { return Displacement::old_velocity; }

 protected:
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
