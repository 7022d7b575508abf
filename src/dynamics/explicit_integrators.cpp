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
    const size_t n = state.q.size();
    // Velocities with which pinned vertices arrive where they are prescribed.
    std::vector<double> pinned_velocity = pin_velocity(tools, h, state);

    // M a = -dV/dq - C qdot, with the pinned accelerations known.
    std::vector<double> acceleration(n, 0.0), Ma(n), g(n, 0.0), drift(n);
    for (size_t i = 0; i < n; ++i) drift[i] = state.q[i] + h * state.qdot[i];
    for (const Energy* V : tools.E.potential()) V->add_gradient(state.q, 1, g);
    for (const Energy* D : tools.E.damping()) D->add_gradient(drift, 1, g);
    for (size_t i = 0; i < n; ++i)
      if (tools.pins.holds(static_cast<int>(i / 3))) acceleration[i] = (pinned_velocity[i] - state.qdot[i]) / h;
    tools.model.mass->multiply(acceleration, Ma);
    for (size_t i = 0; i < n; ++i) g[i] = -g[i] - Ma[i];
    tools.pins.set_zero(g);
    const SolveReport solved = solve_mass(tools, g);
    for (size_t i = 0; i < n; ++i)
      if (!tools.pins.holds(static_cast<int>(i / 3))) acceleration[i] = a_[i];

    update(h, acceleration, state);
    state.time += h;
    tools.pins.place(state.time, state.q);

    MinimizeReport report;
    report.iterations = 1;
    report.linear_iterations = solved.iterations;
    const bool finite = std::all_of(state.q.begin(), state.q.end(), [](double x) { return std::isfinite(x); });
    report.status = finite && solved.ok ? Status::converged : Status::undefined;
    return report;
  }

 protected:
  virtual std::vector<double> pin_velocity(const StepTools& tools, double h, const State& state) const = 0;
  virtual void update(double h, std::span<const double> acceleration, State& state) const = 0;

  // (x(time_b) - x(time_a)) / (time_b - time_a) of the pinned vertices, zero elsewhere
  static std::vector<double> mean_pin_velocity(const Pins& pins, double time_a, double time_b, size_t n) {
    std::vector<double> a(n, 0.0), b(n, 0.0);
    pins.place(time_a, a);
    pins.place(time_b, b);
    for (size_t i = 0; i < n; ++i) b[i] = (b[i] - a[i]) / (time_b - time_a);
    return b;
  }

 private:
  SolveReport solve_mass(const StepTools& tools, std::span<const double> force) {
    if (!solver_) {
      solver_ = make_linear_solver("auto");
      M_.emplace(tools.E.pattern());
      tools.model.mass->add_to(1, *M_);
      tools.pins.set_identity(*M_);
      solver_->analyze(tools.E.pattern());
      factorized_ = solver_->factorize(*M_);
      a_.resize(force.size());
    }
    return factorized_ ? solver_->solve(force, a_, kSolveTolerance) : SolveReport{};
  }

  std::unique_ptr<LinearSolver> solver_;
  std::optional<BlockSparse> M_;
  std::vector<double> a_;
  bool factorized_ = false;
};

// qdot_new = qdot + h a(q),  q_new = q + h qdot_new
class SymplecticEuler : public ExplicitIntegrator {
 public:
  std::string_view name() const override { return "symplectic_euler"; }
  Displacement displacement() const override { return Displacement::new_velocity; }

 protected:
  std::vector<double> pin_velocity(const StepTools& tools, double h, const State& state) const override {
    return mean_pin_velocity(tools.pins, state.time, state.time + h, state.q.size());
  }
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
  std::vector<double> pin_velocity(const StepTools& tools, double h, const State& state) const override {
    return mean_pin_velocity(tools.pins, state.time + h, state.time + 2 * h, state.q.size());
  }
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
