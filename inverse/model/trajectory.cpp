#include "model/trajectory.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/check.h"
#include "base/error.h"
#include "base/formatted.h"
#include "dynamics/integrator.h"
#include "dynamics/simulation_checks.h"
#include "model/checkpointing.h"
#include "model/elastic_parameters.h"
#include "model/limits.h"
#include "model/sequence_solver.h"
#include "optimize/newton.h"

namespace aspic {
namespace {

constexpr char kIntegrator[] = "backward_euler";
void require_gradient(const TrajectoryOptions& options) {
  if (options.integrator != kIntegrator)
    throw InvalidInput("a trajectory has a gradient for integrator = 'backward_euler', not for '" + options.integrator +
                       "'");
  if (!(options.h > 0) || !std::isfinite(options.h))
    throw InvalidInput("the time step is " + std::to_string(options.h) + " s; it must be positive");
  if (options.steps < 0) throw InvalidInput("the number of steps is negative");
  if (options.stored_states < 1) throw InvalidInput("stored_states must be at least 1");
}

std::vector<const Damping*> damping_of(const Model& model) {
  std::vector<const Damping*> terms;
  for (const auto& D : model.damping) {
    terms.push_back(dynamic_cast<const Damping*>(D.get()));
    if (!terms.back())
      throw InvalidInput("the damping '" + std::string(D->name()) + "' has no derivatives, so a trajectory with it " +
                         "has no gradient");
  }
  return terms;
}

}  // namespace

struct Trajectory::Impl {
  Impl(Model m, State s, const TrajectoryOptions& o)
      : options((require_gradient(o), o)),
        model(std::move(m)),
        damping(damping_of(model)),
        start(std::move(s)),
        pins(model.pins, start.q),
        E(model, pins),
        newton(make_linear_solver(o.linear)),
        solver(o.adjoint, o.adjoint_tolerance),
        integrator(make_integrator(o.integrator)),
        theta(model) {
    require_mass(model, pins);
    minimize.tolerance = o.tolerance;
    minimize.max_iterations = o.max_iterations;
    minimize.h = o.h;
    minimize.stop = o.stop.discarding();
    place_pins();
    gravity = gravity_of(model, start.q);
    for (auto* v : {&qbar, &vbar, &rhs, &mu, &moved, &Mmu}) v->resize(start.q.size());
    slots.resize(std::min(o.stored_states, std::max(1, o.steps)));
  }

  void place_pins() {
    pins.place(start.time, start.q);
    integrator->set_pin_velocity(pins, options.h, start);
  }

  double time_of(int step) const { return start.time + step * options.h; }

  void begin() {
    report = {};
    now = start;
    point = 0;
    visited = -1;
    newton.begin();
    solver.begin();
  }

  bool fail(int step, const std::string& reason) {
    report.message =
        "the step from " + formatted("%.4g", time_of(step)) + " s (step " + std::to_string(step) + "): " + reason;
    return false;
  }

  // Adds the value of the objective at a point when the motion reaches it for the first time.
  void visit(int number, const State& state) {
    if (number <= visited) return;
    visited = number;
    report.value += (*objective)(number, state, {}, {});
  }

  // Takes a step from `now` to `end`, which may be the same object.
  bool step(State& end) {
    const SolveTools solve{model, pins, E, minimizer, newton, minimize, observe, InitialGuess::best};
    before = now;
    const StepSolve solved = integrator->advance({solve, before, nullptr, options.h, time_of(point + 1)}, next, forces);
    ++report.steps;
    report.newton_iterations += solved.work.iterations;
    report.factorizations += solved.work.factorizations;
    if (!is_success(solved.work.status))
      return fail(point, "Newton's method did not converge: " + std::string(to_string(solved.work.status)) + " after " +
                             std::to_string(solved.work.iterations) + " iterations");
    std::swap(end, next);
    return true;
  }

  bool advance() {
    if (!step(now)) return false;
    visit(++point, now);
    return true;
  }

  TrajectoryReport simulate(const TrajectoryObjective& function) {
    begin();
    objective = &function;
    visit(0, now);
    report.ok = true;
    while (report.ok && point < options.steps) report.ok = advance();
    return report;
  }

  TrajectoryReport differentiate(const TrajectoryObjective& function, TrajectoryGradient& gradient) {
    begin();
    objective = &function;
    reset(gradient);
    for (auto* v : {&qbar, &vbar}) std::fill(v->begin(), v->end(), 0.0);
    visit(0, now);
    if (options.steps == 0) function(0, now, qbar, vbar);
    const ChainOperations chain{.advance = [this] { return advance(); },
                                .store =
                                    [this](int slot) {
                                      slots[slot] = {now, point};
                                    },
                                .restore = [this](int slot) { now = slots[slot].state, point = slots[slot].point; },
                                .reverse = [&](int step_number) { return reverse(step_number, gradient); }};
    report.ok = reverse_chain(options.steps, static_cast<int>(slots.size()), chain);
    pins.set_zero(qbar);
    pins.set_zero(vbar);  // the pins prescribe these velocities
    gradient.q.assign(qbar.begin(), qbar.end());
    gradient.qdot.assign(vbar.begin(), vbar.end());
    return report;
  }

  bool reverse(int step_number, TrajectoryGradient& gradient) {
    ASPIC_CHECK(point == step_number);
    if (step_number == options.steps - 1) {
      if (!step(after)) return false;
      visit(options.steps, after);
      (*objective)(options.steps, after, qbar, vbar);
    }
    if (!reverse_step(gradient)) return false;
    (*objective)(point, now, qbar, vbar);
    std::swap(after.q, now.q), std::swap(after.qdot, now.qdot);
    return true;
  }

  void reset(TrajectoryGradient& gradient) const {
    gradient.elastic.assign(theta.size(), 0.0);
    gradient.density.assign(gravity ? model.mesh.tet_count() : 0, 0.0);
    gradient.damping.resize(damping.size());
    for (size_t k = 0; k < damping.size(); ++k) gradient.damping[k].assign(damping[k]->coefficient_count(), 0.0);
  }

  // Replaces the derivatives with respect to `after` by those with respect to `now`.
  bool reverse_step(TrajectoryGradient& gradient) {
    const double h = options.h, f = h * h;
    if (options.stop.stopped()) return fail(point, "stopped");
    begin_step();
    pins.set_zero(qbar);  // the pins prescribe these positions
    for (size_t i = 0; i < rhs.size(); ++i) rhs[i] = qbar[i] + vbar[i] / h;
    pins.set_zero(rhs);
    if (!solve()) return false;

    model.mass->multiply(mu, Mmu);
    for (size_t i = 0; i < mu.size(); ++i) qbar[i] = Mmu[i] - vbar[i] / h;
    for (size_t i = 0; i < mu.size(); ++i) vbar[i] = h * Mmu[i];
    theta.add_gradient(after.q, mu, -f, gradient.elastic);
    for (size_t k = 0; k < damping.size(); ++k) add_damping(k, f, gradient.damping[k], gradient);
    if (gravity) add_density(f, gradient.density);
    pins.set_zero(qbar);
    return true;
  }

  // Prepares the terms as the integrator does.
  void begin_step() {
    const StepContext context{now.q, options.h, time_of(point + 1), now.q};
    for (size_t i = 0; i < moved.size(); ++i) moved[i] = now.q[i] + options.h * now.qdot[i];
    E.at({.predicted = moved, .factor = options.h * options.h, .context = context});
  }

  bool solve() {
    const BlockSparse& H = E.hessian(after.q, {Definiteness::exact});
    const auto [solved, factorized] = solver.solve(H, rhs, mu);
    ++report.adjoint_solves;
    report.adjoint_factorizations += factorized;
    report.adjoint_iterations += solved.iterations;
    if (solved.ok || (!solved.indefinite && solved.relative_residual <= kStagnated)) return true;
    return fail(point, solved.indefinite ? "the matrix of the step is not positive definite"
                                         : "the adjoint system was not solved");
  }

  void add_damping(size_t k, double f, std::span<double> coefficients, TrajectoryGradient& gradient) {
    const Damping& D = *damping[k];
    const Energy::Context& context = E.terms().damping()[k].context();
    D.add_derivatives(after.q, context, mu, -f, {.start = qbar, .coefficients = coefficients});
    const LaggedStiffness stiffness = D.lagged_stiffness(context);
    if (!stiffness.elasticity) return;
    std::vector<double> u(after.q.size());
    for (size_t i = 0; i < u.size(); ++i) u[i] = after.q[i] - now.q[i];
    theta.add_hessian_derivatives(*stiffness.elasticity, stiffness.shape, {mu, u, stiffness.definiteness},
                                  {-f / options.h * stiffness.factor, qbar, gradient.elastic});
  }

  // Adds -mu' dg/drho of inertia, weight and mass-proportional damping.
  void add_density(double f, std::span<double> density) {
    const TetMesh& mesh = model.mesh;
    for (size_t i = 0; i < moved.size(); ++i) moved[i] -= after.q[i];  // q0 + h v0 - q1
    for (size_t k = 0; k < damping.size(); ++k)
      for (size_t i = 0; i < moved.size(); ++i)
        if (const double a = damping[k]->mass_factor(static_cast<int>(i / 3)); a != 0)
          moved[i] -= options.h * a * (after.q[i] - now.q[i]);
    add_density_gradient(mesh, model.mass->kind(), mu, moved, density);
    std::vector<double> weight(moved.size());
    for (size_t i = 0; i < weight.size(); ++i) weight[i] = f * (*gravity)[i % 3];
    add_density_gradient(mesh, model.mass->kind(), mu, weight, density);
  }

  struct Stored {
    State state;
    int point = 0;
  };

  TrajectoryOptions options;
  Model model;
  std::vector<const Damping*> damping;  // of the model
  State start;
  Pins pins;
  IncrementalPotential E;
  Newton newton;
  SequenceSolver solver;  // solver for H, backward in time
  std::unique_ptr<Integrator> integrator;
  ElasticParameters theta;
  Minimizer minimizer;
  MinimizeOptions minimize;
  IterationObserver observe;
  std::optional<Vec3d> gravity;  // acceleration of the load 'gravity'
  TrajectoryReport report;
  const TrajectoryObjective* objective = nullptr;
  State now, after;  // the current state; in the backward pass, the state after it
  int point = 0, visited = -1;
  std::vector<Stored> slots;
  std::vector<double> qbar, vbar;
  // Scratch. moved: q0 + h v0.
  State before, next;
  StepForces forces;
  std::vector<double> rhs, mu, moved, Mmu;
};

Trajectory::Trajectory(Model model, State start, const TrajectoryOptions& options)
    : impl_(std::make_unique<Impl>(std::move(model), std::move(start), options)) {}
Trajectory::~Trajectory() = default;
Trajectory::Trajectory(Trajectory&&) noexcept = default;

const Model& Trajectory::model() const { return impl_->model; }
Model Trajectory::release_model() && { return std::move(impl_->model); }
void Trajectory::set_parameters(std::span<const MaterialParameters> parameters) { impl_->theta.set(parameters); }
void Trajectory::set_start(const State& start) {
  ASPIC_CHECK(start.q.size() == impl_->start.q.size() && start.qdot.size() == start.q.size());
  impl_->start = start;
  impl_->pins = Pins(impl_->model.pins, start.q);
  impl_->place_pins();
}

TrajectoryReport Trajectory::simulate(const TrajectoryObjective& objective) { return impl_->simulate(objective); }
TrajectoryReport Trajectory::differentiate(const TrajectoryObjective& objective, TrajectoryGradient& gradient) {
  return impl_->differentiate(objective, gradient);
}

std::optional<Vec3d> gravity_of(const Model& model, std::span<const double> q) {
  const Energy* load = nullptr;
  for (const auto& V : model.loads)
    if (V->name() == "gravity") {
      if (load) return std::nullopt;
      load = V.get();
    }
  if (!load) return Vec3d{};
  std::vector<double> force(q.size()), weight(q.size());
  ActiveTerm(*load).add_gradient(q, -1, force);
  Vec3d total{};
  for (size_t i = 0; i < force.size(); ++i) total[i % 3] += force[i];
  const Vec3d acceleration = (1 / model.mass->total()) * total;
  double error = 0, size = 0;
  for (size_t i = 0; i < force.size(); ++i) {
    const double expected = model.mass->row_sums()[i / 3] * acceleration[i % 3];
    error = std::max(error, std::abs(force[i] - expected));
    size = std::max(size, std::abs(expected));
  }
  return error <= 1e-9 * size ? std::optional(acceleration) : std::nullopt;
}

}  // namespace aspic
