#include "dynamics/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "dynamics/integrator.h"
#include "dynamics/ledger.h"

namespace aspic {
namespace {

std::string listed(const std::vector<int>& indices) {
  std::string text;
  for (size_t i = 0; i < std::min<size_t>(indices.size(), 5); ++i) text += (i ? ", " : "") + std::to_string(indices[i]);
  return text + (indices.size() > 5 ? ", ..." : "");
}

// Squares overflow before positions do, so a state may be finite while its energies are not.
bool is_finite(const StepReport& report) {
  return std::isfinite(report.residual) && std::isfinite(report.kinetic) && std::isfinite(report.potential_total);
}

void require_mass(const Model& model, const Pins& pins) {
  std::vector<int> massless;
  for (int v = 0; v < model.mesh.vertex_count(); ++v)
    if (!pins.holds(v) && !(model.mass->vertex_mass()[v] > 0)) massless.push_back(v);
  if (!massless.empty())
    throw InvalidInput(std::to_string(massless.size()) + " vertices have no mass (" + listed(massless) +
                       "): they belong to no tet, or the density there is zero; remove them (--repair) or pin them");
}

void require_finite_energy(const Model& model, std::span<const double> x) {
  for (const double xi : x)
    if (!std::isfinite(xi)) throw InvalidInput("the initial positions or velocities are not finite");
  for (size_t body = 0; body < model.elasticity.size(); ++body) {
    if (std::isfinite(model.elasticity[body]->value(x))) continue;
    TetFields fields;
    fields.energy_density.resize(model.mesh.tet_count());
    fields.det_F = fields.von_mises = fields.energy_density;
    fields.cauchy.resize(6 * fields.det_F.size());
    std::fill(fields.det_F.begin(), fields.det_F.end(), 1.0);
    model.elasticity[body]->evaluate(x, fields);
    std::vector<int> inverted;
    for (int t = 0; t < model.mesh.tet_count(); ++t)
      if (!(fields.det_F[t] > 0)) inverted.push_back(t);
    if (inverted.empty())
      throw InvalidInput(
          "the initial shape has infinite energy: its strain is more than the material can take; choose a "
          "smaller initial deformation or another material");
    throw InvalidInput("the initial shape has infinite energy: " + std::to_string(inverted.size()) +
                       " tets are inverted or flat (" + listed(inverted) +
                       "); choose a smaller initial deformation, or a material that tolerates inversion, such as "
                       "neo_hookean or stable_neo_hookean");
  }
}

}  // namespace

struct Simulation::Impl {
  Impl(Model m, State initial, SimulationOptions o)
      : model(std::move(m)),
        options(std::move(o)),
        state(std::move(initial)),
        start(state),
        integrator(make_integrator(options.integrator)),
        direction(make_search_direction(options.solver)),
        pins(std::make_unique<Pins>(model.pins, start.q)),
        E(std::make_unique<IncrementalPotential>(model, *pins)) {
    options.solver.minimize.h = options.h;
    if (!(options.h > 0) || !std::isfinite(options.h))
      throw InvalidInput("time.step = " + std::to_string(options.h) + "; it must be positive");
    if (!integrator->is_static()) require_mass(model, *pins);
    pins->place(state.time, state.q);
    require_finite_energy(model, state.q);
    // The pinned vertices of a scheme that moves with the old velocity must know where they are going.
    if (integrator->displacement() == Displacement::old_velocity) set_pin_velocity();
  }

  void set_pin_velocity() {
    std::vector<double> next = state.q;
    pins->place(state.time + options.h, next);
    for (size_t i = 0; i < next.size(); ++i)
      if (pins->holds(static_cast<int>(i / 3))) state.qdot[i] = (next[i] - state.q[i]) / options.h;
  }

  // A product, not a sum of steps, so that the end of a run is met exactly.
  double end_of_next_step() const { return start.time + (steps_taken + 1) * options.h; }

  StepTools tools(const IterationObserver& observe) {
    return {model, *pins, *E, minimizer, *direction, options.solver.minimize, observe, end_of_next_step()};
  }

  // Tells every term that a step from `from` is about to end at `time`.
  void begin_step(Positions from, double time) const {
    const StepContext context{from, integrator->is_static() ? 0 : options.h, time};
    for (Energy* V : E->potential()) V->begin_step(context);
    for (Energy* D : E->damping()) D->begin_step(context);
  }

  StepReport step(const IterationObserver& observe) {
    const auto began = std::chrono::steady_clock::now();
    const StepTools with = tools(observe);
    before = state;
    ledger.open(with, state);
    begin_step(before.q, with.end_time);
    ledger.targets_moved(with, state);

    const MinimizeReport solved = integrator->advance(with, options.h, state);
    StepReport report = described(solved);
    if (solved.status == Status::interrupted || solved.status == Status::undefined) {
      state = before;  // there is nothing to go on from
      if (solved.status == Status::undefined) state.time = with.end_time;
    }
    report.time = state.time;
    if (solved.status != Status::interrupted) report.step = ++steps_taken;
    ledger.close(with, *integrator, options.h, state, report);
    if (is_success(report.status) && !is_finite(report)) report.status = Status::undefined;
    if (solved.status == Status::interrupted) begin_step(state.q, state.time);  // targets go back where they stood
    report.min_det_F = INFINITY;
    for (const auto& V : model.elasticity) report.min_det_F = std::min(report.min_det_F, V->min_det_F(state.q));
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return report;
  }

  StepReport described(const MinimizeReport& solved) const {
    StepReport report;
    report.status = solved.status;
    report.criterion = options.solver.minimize.criterion;
    report.iterations = solved.iterations;
    report.trials = solved.trials;
    report.linear_iterations = solved.linear_iterations;
    report.hessians = solved.hessians;
    report.projected_hessians = solved.projected_hessians;
    const bool judges_forces = integrator->is_implicit() && !judges_direction(report.criterion);
    if (judges_forces) report.residual_threshold = solved.threshold / E->gradient_unit();
    if (integrator->is_implicit()) report.residual_round_off = solved.gradient_round_off / E->gradient_unit();
    return report;
  }

  Model model;
  SimulationOptions options;
  State state, start;
  State before;  // the state before the last step
  std::unique_ptr<Integrator> integrator;
  std::unique_ptr<SearchDirection> direction;
  std::unique_ptr<Pins> pins;
  std::unique_ptr<IncrementalPotential> E;
  Minimizer minimizer;
  Ledger ledger;
  int steps_taken = 0;
};

Simulation::Simulation(Model model, State initial, SimulationOptions options) {
  const size_t n = 3 * static_cast<size_t>(model.mesh.vertex_count());
  if (initial.q.size() != n || initial.qdot.size() != n)
    throw InvalidInput("the initial state has " + std::to_string(initial.q.size()) + " and " +
                       std::to_string(initial.qdot.size()) + " entries; the model needs " + std::to_string(n));
  impl_ = std::make_unique<Impl>(std::move(model), std::move(initial), std::move(options));
}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

StepReport Simulation::step(const IterationObserver& observe) { return impl_->step(observe); }
const Model& Simulation::model() const { return impl_->model; }
const State& Simulation::state() const { return impl_->state; }
const SimulationOptions& Simulation::options() const { return impl_->options; }
int Simulation::steps_taken() const { return impl_->steps_taken; }

std::vector<std::string> Simulation::potential_names() const {
  std::vector<std::string> names;
  for (size_t body = 0; body < impl_->model.elasticity.size(); ++body) {
    const bool one = impl_->model.bodies.size() <= 1;
    names.push_back(one ? "elasticity" : "elasticity_" + impl_->model.bodies[body].name);
  }
  for (const auto& V : impl_->model.loads) names.emplace_back(V->name());
  return names;
}

double Simulation::kinetic_energy() const {
  std::vector<double> momentum(impl_->state.qdot.size());
  return aspic::kinetic_energy(*impl_->model.mass, impl_->state.qdot, momentum);
}

std::vector<double> Simulation::potential_energies() const {
  std::vector<double> energies;
  for (const Energy* V : impl_->E->potential()) energies.push_back(V->value(impl_->state.q));
  return energies;
}

TetFields Simulation::tet_fields() const {
  const size_t tets = impl_->model.mesh.tets.size();
  TetFields fields{std::vector<double>(tets), std::vector<double>(tets, 1.0), std::vector<double>(6 * tets),
                   std::vector<double>(tets)};
  for (const auto& V : impl_->model.elasticity) V->evaluate(impl_->state.q, fields);
  return fields;
}

bool Simulation::is_implicit() const { return impl_->integrator->is_implicit(); }

StableStep Simulation::stable_step() const {
  const StableStep stable = aspic::stable_step(*impl_->E, impl_->model, *impl_->pins, impl_->start.q);
  impl_->begin_step(impl_->state.q, impl_->state.time);
  return stable;
}

std::string Simulation::solver_description() const { return impl_->direction->description(); }

Simulation::Snapshot Simulation::snapshot() const { return {impl_->state, impl_->start, impl_->steps_taken, {}}; }

void Simulation::restore(const Snapshot& snapshot) {
  const size_t n = impl_->state.q.size();
  for (const auto* v : {&snapshot.state.q, &snapshot.state.qdot, &snapshot.start.q, &snapshot.start.qdot})
    if (v->size() != n)
      throw InvalidInput("the checkpoint has " + std::to_string(v->size()) + " entries; this scene needs " +
                         std::to_string(n));
  impl_->state = snapshot.state;
  impl_->start = snapshot.start;
  impl_->steps_taken = snapshot.steps_taken;
  *impl_->pins = Pins(impl_->model.pins, impl_->start.q);
  impl_->begin_step(impl_->state.q, impl_->state.time);  // moving targets stand where they stood
}

}  // namespace aspic
