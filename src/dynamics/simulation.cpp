#include "dynamics/simulation.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <numeric>
#include <optional>

#include "base/error.h"
#include "base/formatted.h"
#include "base/stopwatch.h"
#include "contact/barrier.h"
#include "dynamics/adaptive_step.h"
#include "dynamics/integrator.h"
#include "dynamics/ledger.h"
#include "dynamics/simulation_checks.h"
#include "dynamics/state.h"
#include "energy/attachment.h"
#include "math/vectors.h"

namespace aspic {
namespace {

// Energies are squares, which overflow before positions do.
bool is_finite(const StepReport& report) {
  return std::isfinite(report.residual) && std::isfinite(report.kinetic) && std::isfinite(report.potential_total);
}

// Empty: those at the start of a simulation.
void require_internal(const std::vector<double>& internal, size_t size) {
  if (!internal.empty() && internal.size() != size)
    throw InvalidInput("the state has " + std::to_string(internal.size()) + " internal variables; the model needs " +
                       std::to_string(size));
}

}  // namespace

struct Simulation::Impl {
  Impl(Model m, State initial, SimulationOptions o)
      : model(std::move(m)),
        options(std::move(o)),
        state(std::move(initial)),
        start(state),
        integrator(make_integrator(options.integrator)),
        guess(initial_guess_named(options.initial_guess)),
        direction(make_search_direction(options.solver)),
        pins(std::make_unique<Pins>(model.pins, start.q)),
        E(std::make_unique<IncrementalPotential>(model, *pins)) {
    options.solver.minimize.h = options.h;
    if (!(options.h > 0) || !std::isfinite(options.h))
      throw InvalidInput("h = " + three_digits(options.h) + "; it must be positive");
    require_possible(options);
    if (!integrator->facts().is_static()) require_mass(model, *pins);
    E->terms().internal().require_support(integrator->facts());
    pins->place(state.time, state.q);
    if (state.internal.empty()) state.internal = E->terms().internal().initial(state.q);
    require_finite_energy(model, state.q);
    require_apart(model, state, integrator->facts());
    if (model.contact && options.adaptive.tolerance > 0)
      throw InvalidInput("contact needs a constant step length; turn adaptive steps off and choose a smaller step");
    if (!integrator->facts().is_static()) integrator->set_pin_velocity(*pins, options.h, state);
    if (options.adaptive.tolerance > 0) adaptive.emplace(model, options.adaptive.tolerance, needs_previous());
    ledger.begin(model, state.q);
    measure_start();
  }

  // Returns whether the start of the previous step is needed.
  bool needs_previous() const {
    const bool by_guess =
        guess == InitialGuess::best || guess == InitialGuess::last_increment || guess == InitialGuess::accelerated;
    return integrator->facts().is_multistep || (by_guess && integrator->facts().chooses_guess());
  }

  // A product instead of a sum of steps, so that the end of a run is exact.
  double end_of_next_step() const { return start.time + (steps_taken + 1) * options.h; }

  // Returns the arguments of a step that starts at `before`.
  StepTools tools(const IterationObserver& observe, double end_time) {
    const SolveTools solve{model, *pins, *E, minimizer, *direction, minimize, observe, guess};
    return {solve, before, has_previous ? &previous : nullptr, options.h, end_time, obstacle_time, end_time};
  }

  StepReport step(const IterationObserver& observe, const StopToken& stop) {
    Stopwatch stopwatch;
    const std::clock_t cpu = std::clock();
    const ContactCost cost = model.contact ? model.contact->meter().total() : ContactCost{};
    before = state;
    minimize = options.solver.minimize;
    minimize.stop = stop.discarding();
    if (const double budget = options.solver.time_budget; budget > 0)
      minimize.stop = minimize.stop.with_deadline(options.clock, budget).earlier_by(report_seconds);
    const StepTools with = tools(observe, end_of_next_step());
    StepReport report;
    StepSolve solved = adaptive ? adaptive->advance(*integrator, with, ledger, state, report)
                                : integrator->advance(with, state, forces);
    const double advanced = minimize.stop.now();
    describe(solved, report);
    const bool is_interrupted = solved.work.status == Status::interrupted;
    if (!can_continue(report.status)) {
      restore_start(with, is_interrupted ? before.time : with.end_time, report);
    } else {
      if (!adaptive) {
        const BoundedEnergies bounded = ledger.add(with, *integrator, state, forces, report);
        if (integrator->facts().is_backward_euler && !E->terms().has_rims())  // their forces have no potential
          check_energy_bound(bounded, solved.work.value / (options.h * options.h), report);
      }
      if (!integrator->facts().is_implicit) outside_work += outside_work_of(report);
      note_lost_residual(report);
      note_lost_velocity(with, report);
      if (!is_finite(report)) {
        if (is_success(report.status)) report.status = Status::undefined;
        restore_start(with, with.end_time, report);
      } else {
        obstacle_time = with.end_time;
        if (is_success(report.status) && has_blown_up(report)) {
          report.status = Status::unstable;
        } else if (needs_previous()) {
          previous = adaptive ? adaptive->previous() : before;
          previous.internal.clear();  // not needed
          // Obstacles that were blocked have another history.
          has_previous = !integrator->facts().is_multistep || with.obstacle_start == before.time;
        }
      }
    }
    if (!is_interrupted) report.step = ++steps_taken;
    has_stepped = !is_interrupted;
    describe_state(report);
    report_seconds = minimize.stop.now() - advanced;
    report.seconds = stopwatch.lap();
    report.cpu_seconds = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
    if (model.contact) report.contact_cost = model.contact->meter().total().since(cost);
    return report;
  }

  // Computes the initial energies for has_blown_up().
  void measure_start() {
    if (integrator->facts().is_implicit) return;
    constexpr double kRoundOff = 1e-12;  // round-off of elastic energies, relative to the stiffness of the body
    set_time(start.time);
    start_force.assign(start.q.size(), 0.0);
    start_energy = aspic::kinetic_energy(model, start.qdot, start_force) + kRoundOff * E->sizes().growth_stiffness();
    start_force.assign(start.q.size(), 0.0);
    for (const auto& V : model.elasticity) start_energy += std::abs(V->value(start.q));
    for (const ActiveTerm& V : E->terms().loads())
      if (!V.energy().has_constant_gradient()) start_energy += std::abs(V.value(start.q));  // such as springs
    // A convex V decreases by at most -dV/dx (x - x at the start).
    for (const ActiveTerm& V : E->terms().loads()) V.add_gradient(start.q, 1, start_force);
    // First-order schemes give a body at rest this energy in the first step.
    const std::span<const double> mass = model.mass->row_mass();
    for (size_t i = 0; i < start_force.size(); ++i)
      if (mass[i / 3] > 0) start_energy += 0.5 * options.h * options.h * start_force[i] * start_force[i] / mass[i / 3];
  }

  static double outside_work_of(const StepReport& report) {
    double targets = 0, size = 0;
    for (const double work : report.target_work) targets += work, size += std::abs(work);
    return size + std::abs(report.pin_work - targets);
  }

  // An explicit scheme with too long a step generates energy until numbers overflow. Returns whether the body has ten
  // times the sum of its initial energy and a bound of the work of loads, moving pins and moving targets. During a
  // blow-up, this bound grows linearly with the displacements, but the energy quadratically.
  bool has_blown_up(const StepReport& report) {
    constexpr double kBlownUp = 10;
    if (integrator->facts().is_implicit) return false;
    load_force.assign(start.q.size(), 0.0);
    for (const ActiveTerm& V : E->terms().loads())
      if (V.energy().has_constant_gradient()) V.add_gradient(state.q, 1, load_force);
    double allowed = start_energy + outside_work, reached = report.kinetic;
    for (size_t i = 0; i < start_force.size(); ++i)
      allowed += (std::abs(start_force[i]) + std::abs(load_force[i])) * std::abs(state.q[i] - start.q[i]);
    for (size_t body = 0; body < model.elasticity.size(); ++body) reached += report.potential[body];
    return reached > kBlownUp * allowed;
  }

  // The minimizer tests its own gradient. The residual of the report follows from velocities and accelerations, which
  // have the rounding errors of positions.
  void note_lost_residual(StepReport& report) const {
    if (report.status != Status::converged || report.residual_threshold == 0) return;
    if (report.residual <= report.residual_threshold) return;
    const MinimizeOptions& solver = options.solver.minimize;
    if (solver.criterion == Criterion::scale)
      report.lost_accuracy = std::min(1.0, solver.tolerance * (report.residual / report.residual_threshold));
    report.status = Status::round_off;
  }

  // Velocities are differences of rounded positions.
  void note_lost_velocity(const StepTools& with, StepReport& report) const {
    if (!integrator->facts().is_implicit || integrator->facts().is_static() || !is_success(report.status)) return;
    double position = 0, speed = 0, change = 0;
    for (size_t i = 0; i < state.q.size(); ++i) {
      position = std::max(position, std::abs(state.q[i]));
      speed = std::max(speed, std::abs(with.start.qdot[i]));
      change = std::max(change, std::abs(forces.acceleration.empty() ? 0 : forces.acceleration[i]) * with.h);
    }
    for (double* size : {&position, &speed, &change}) *size = model.share.max(*size);
    const double round_off = std::numeric_limits<double>::epsilon() * position / with.h, most = std::max(speed, change);
    if (most == 0 || round_off <= kResolved * most) return;
    report.lost_accuracy = std::max(report.lost_accuracy, std::min(1.0, round_off / most));
    report.status = Status::round_off;
  }

  // A run may continue after an incomplete minimization, but not after an incomplete adaptive step.
  bool can_continue(Status status) const {
    if (status == Status::interrupted || status == Status::undefined) return false;
    return !adaptive || is_success(status);
  }

  // Sets the time of the terms of V between steps.
  void set_time(double time) const {
    E->terms().begin_potential({state.q, integrator->facts().is_static() ? 0 : options.h, time});
    E->terms().move_obstacles(obstacle_time);
  }

  // Restores the state at the start of the step, with the given time; moving targets are at that time. A multistep
  // scheme restarts.
  void restore_start(const StepTools& with, double time, StepReport& report) {
    report.residual = report.residual_threshold = report.residual_round_off = 0;
    report.worst_vertex = -1;
    report.pin_work = report.load_work = report.muscle_work = 0;
    report.obstacle_work = report.nonconservative_work = 0;
    report.damping_loss = report.friction_loss = report.viscoelastic_loss = 0;
    report.friction_creep = report.friction_residual = 0;
    report.friction_pair.clear();
    report.numerical_loss = report.residual_work = report.ledger_error = report.energy_slack = 0;
    report.energy_bound = EnergyBound::none;
    report.target_work.clear();
    report.resultants = {};
    state = before;
    state.time = time;
    has_previous = has_previous && time == before.time;
    StepTools stand_still = tools(with.observe, time);
    stand_still.obstacle_end = obstacle_time;
    stand_still.is_dropped = true;
    set_time(time);
    forces.reset(state.q.size());
    for (const ActiveTerm& V : E->terms().potential()) V.add_gradient(state.q, 1, forces.gradient);
    ledger.add(stand_still, *integrator, state, forces, report);
  }

  void describe_state(StepReport& report) const {
    report.time = state.time;
    if (model.contact) {
      const ContactSummary contact = model.contact->summary(state.q, obstacle_time);
      report.contacts = contact.contacts;
      report.min_gap = contact.contacts > 0 ? contact.min_gap : 0;
      if (contact.contacts > 0) report.min_gap_pair = model.contact->mesh().pair_name(contact.parts);
      report.max_pressure = contact.max_pressure;
      report.gap_error = contact.widest_reach;
      report.contact_force_error = force_error(contact.gap_work, report);
    }
    report.min_det_F = INFINITY;
    for (const auto& V : model.elasticity) {
      const double least = V->min_det_F(state.q);
      report.min_det_F = std::min(report.min_det_F, least);
      if (least <= 0 && V->excludes_inversion() && is_success(report.status)) report.status = Status::inverted;
    }
    report.cavities.clear();
    report.attachment_gap = 0;
    for (const auto& load : model.loads) {
      if (const auto* cavity = dynamic_cast<const Cavity*>(load.get()))
        report.cavities.push_back(cavity->state(state.q, state.time));
      if (const auto* attachment = dynamic_cast<const Attachment*>(load.get()))
        report.attachment_gap = std::max(report.attachment_gap, attachment->largest_gap(state.q));
    }
    report.state_hash = hash();
  }

  // In statics: a linear body that is shortened by s needs the force K s. Gaps g shorten it by s + g, with the energy
  // K (s + g)^2 / 2. Hence the force is too large by the fraction g / (s + g) of itself.
  double force_error(double gap_work, const StepReport& report) const {
    const auto first = report.potential.begin();
    const size_t bodies = std::min(model.elasticity.size(), report.potential.size());
    const double elastic = std::accumulate(first, first + static_cast<std::ptrdiff_t>(bodies), 0.0);
    if (!integrator->facts().is_static() || !(gap_work > 0)) return 0;
    return elastic > gap_work / 2 ? gap_work / (2 * elastic) : 1;
  }

  std::uint64_t hash() const {
    const std::uint64_t positions = aspic::state_hash(state, model.numbering.vertex);
    return continued_hash(positions, E->terms().internal().to_user(state.internal, model.numbering.tet));
  }

  void describe(const StepSolve& solved, StepReport& report) const {
    report.status = solved.work.status;
    report.criterion = options.solver.minimize.criterion;
    report.iterations = solved.work.iterations;
    report.carries = solved.work.carries;
    report.trials = solved.work.trials;
    report.projected_hessians = solved.work.projected_hessians;
    report.add(solved.work);  // substeps of an adaptive step are already in the ledger
    report.elements = model.mesh.tet_count();
    report.objective = solved.work.value;
    report.objective_gradient = solved.work.gradient_norm;
    report.decrement = solved.decrement;
    report.friction_passes = solved.passes;
    report.step_limit = E->step_limit();
    report.lost_accuracy = solved.work.lost_accuracy;
    report.initial_guess = solved.guess;
  }

  Model model;
  SimulationOptions options;
  State state, start;
  State before;    // the state before the last step
  State previous;  // the state before `before`, if the integrator or the guess needs it
  bool has_previous = false;
  std::unique_ptr<Integrator> integrator;
  InitialGuess guess;
  std::unique_ptr<SearchDirection> direction;
  std::unique_ptr<Pins> pins;
  std::unique_ptr<IncrementalPotential> E;
  Minimizer minimizer;
  std::optional<AdaptiveStep> adaptive;
  StepForces forces;                // forces of the last step
  std::vector<double> start_force;  // dV/dx of the loads at the start of an explicit run [N]
  std::vector<double> load_force;   // current dV/dx of the loads that do not depend on x [N]
  double start_energy = 0;          // kinetic and elastic energy at the start of an explicit run [J]
  double outside_work = 0;          // see Snapshot
  Ledger ledger;
  int steps_taken = 0;
  bool has_stepped = false;           // since the construction or restore()
  double obstacle_time = state.time;  // see Simulation::obstacle_time()
  MinimizeOptions minimize;           // options of the current step
  double report_seconds = 0;          // duration of the last report, with a time budget [s]
};

Simulation::Simulation(Model model, State initial, SimulationOptions options) {
  const size_t n = 3 * static_cast<size_t>(model.rows());
  if (initial.q.size() != n || initial.qdot.size() != n)
    throw InvalidInput("the initial state has " + std::to_string(initial.q.size()) + " and " +
                       std::to_string(initial.qdot.size()) + " entries; the model needs " + std::to_string(n));
  require_internal(initial.internal, InternalTerms(model).size());
  impl_ = std::make_unique<Impl>(std::move(model), std::move(initial), std::move(options));
}
Simulation::Simulation(Model model, SimulationOptions options) {
  State start = at_rest(model.mesh);
  for (auto* v : {&start.q, &start.qdot}) v->resize(3 * static_cast<size_t>(model.rows()), 0.0);
  *this = Simulation(std::move(model), std::move(start), std::move(options));
}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

StepReport Simulation::step(const IterationObserver& observe, const StopToken& stop) {
  return impl_->step(observe, stop);
}
const Model& Simulation::model() const { return impl_->model; }
const State& Simulation::state() const { return impl_->state; }
const SimulationOptions& Simulation::options() const { return impl_->options; }
std::uint64_t Simulation::state_hash() const { return impl_->hash(); }
int Simulation::steps_taken() const { return impl_->steps_taken; }
double Simulation::obstacle_time() const { return impl_->obstacle_time; }

std::vector<std::string> Simulation::potential_names() const {
  std::vector<std::string> names;
  for (size_t body = 0; body < impl_->model.elasticity.size(); ++body) {
    const bool one = impl_->model.bodies.size() <= 1;
    names.push_back(one ? "elasticity" : "elasticity_" + impl_->model.bodies[body].name);
  }
  for (const auto& V : impl_->model.loads) names.emplace_back(V->name());
  for (std::string& name : impl_->E->terms().internal().names()) names.push_back(std::move(name));
  return names;
}

StepReport Simulation::start_report() const {
  StepReport report;
  impl_->describe_state(report);
  report.elements = impl_->model.mesh.tet_count();
  report.criterion = impl_->options.solver.minimize.criterion;
  report.kinetic = kinetic_energy();
  report.potential = potential_energies();
  for (const double V : report.potential) report.potential_total += V;
  const auto set_nan = [](std::vector<Resultant>& all, size_t count) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const Vec3d vector{{kNan, kNan, kNan}};
    all.assign(count, {vector, vector});
  };
  set_nan(report.resultants.pins, impl_->model.pins.size());
  set_nan(report.resultants.loads, impl_->model.loads.size());
  set_nan(report.resultants.bodies, impl_->model.bodies.size());
  return report;
}

double Simulation::kinetic_energy() const {
  std::vector<double> momentum(impl_->state.qdot.size());
  return aspic::kinetic_energy(impl_->model, impl_->state.qdot, momentum);
}

std::vector<double> Simulation::potential_energies() const {
  std::vector<double> energies;
  for (const ActiveTerm& V : impl_->E->terms().potential()) energies.push_back(V.value(impl_->state.q));
  impl_->E->terms().internal().append_stored(impl_->state.internal, energies);
  return energies;
}

std::vector<double> Simulation::reactions() const {
  const std::span<const double> residual = impl_->ledger.residual();
  std::vector<double> forces(impl_->state.q.size(), std::numeric_limits<double>::quiet_NaN());
  for (int v = 0; v < impl_->pins->rows() && !residual.empty(); ++v)
    set_vec(impl_->pins->held_part(v, point(residual, v)), v, forces);
  return forces;
}

MeshErrorEstimate Simulation::mesh_error(const StopToken& stop) const {
  const Impl& s = *impl_;
  if (!s.model.damping.empty() && !s.has_stepped) {
    MeshErrorEstimate none;
    none.reason = "friction and damping are those of a step; take one first";
    return none;
  }
  const double h = s.options.h;
  return estimate_mesh_error({s.model, *s.pins, s.E->terms(), s.E->pattern(), s.state,
                              s.integrator->facts().is_static(), h, s.state.time - s.start.time},
                             stop);
}

TetFields Simulation::tet_fields() const {
  const auto tets = static_cast<size_t>(impl_->model.mesh.element_count());
  TetFields fields{std::vector<double>(tets), std::vector<double>(tets, 1.0), std::vector<double>(6 * tets),
                   std::vector<double>(tets)};
  for (const auto& V : impl_->model.elasticity) V->evaluate(impl_->state.q, fields);
  return fields;
}

void Simulation::set_solver(const SolverOptions& solver) {
  SimulationOptions options = impl_->options;
  options.solver = solver;
  options.solver.minimize.h = options.h;
  auto direction = make_search_direction(solver);
  require_possible(options);
  impl_->direction = std::move(direction);
  impl_->options = std::move(options);
}

void Simulation::set_direction(std::unique_ptr<SearchDirection> direction) {
  const IntegratorFacts& facts = impl_->integrator->facts();
  if (!facts.is_implicit || facts.takes_one_iteration)
    throw InvalidInput("a search direction of your own has no effect on integrator = '" + impl_->options.integrator +
                       "', which does not minimize; try 'backward_euler'");
  impl_->direction = std::move(direction);
}

void Simulation::set_pins(std::vector<Pin> pins) {
  const Pins new_pins(pins, impl_->start.q);
  if (!impl_->integrator->facts().is_static()) require_mass(impl_->model, new_pins);
  impl_->model.pins = std::move(pins);
  *impl_->pins = Pins(impl_->model.pins, impl_->start.q);
  impl_->E = std::make_unique<IncrementalPotential>(impl_->model, *impl_->pins);
  // Factorizations depend on the pinned rows.
  impl_->direction = make_search_direction(impl_->options.solver);
  impl_->integrator = make_integrator(impl_->options.integrator);
  impl_->set_time(impl_->state.time);
  impl_->has_stepped = false;
}

const IntegratorFacts& Simulation::integrator() const { return impl_->integrator->facts(); }

StableStep Simulation::stable_step() const {
  const StableStep stable =
      aspic::stable_step(*impl_->E, impl_->model, *impl_->pins, impl_->start.q, integrator().stability);
  impl_->set_time(impl_->state.time);
  return stable;
}

std::string Simulation::solver_description() const { return impl_->direction->description(); }

Simulation::Snapshot Simulation::snapshot() const {
  return {impl_->state,
          impl_->start,
          impl_->steps_taken,
          impl_->adaptive ? double(impl_->adaptive->level()) : 0,
          impl_->has_previous ? std::optional(impl_->previous) : std::nullopt,
          impl_->obstacle_time,
          impl_->outside_work};
}

void Simulation::restore(const Snapshot& snapshot) {
  const size_t n = impl_->state.q.size();
  for (const State* s : {&snapshot.state, &snapshot.start, snapshot.previous ? &*snapshot.previous : &snapshot.state})
    for (const auto* v : {&s->q, &s->qdot})
      if (v->size() != n)
        throw InvalidInput("the checkpoint has " + std::to_string(v->size()) + " entries; this scene needs " +
                           std::to_string(n));
  require_internal(snapshot.state.internal, impl_->E->terms().internal().size());
  if (impl_->adaptive) impl_->adaptive->set_level(snapshot.level);
  impl_->state = snapshot.state;
  if (impl_->state.internal.empty()) impl_->state.internal = impl_->E->terms().internal().initial(impl_->state.q);
  impl_->start = snapshot.start;
  impl_->steps_taken = snapshot.steps_taken;
  impl_->outside_work = snapshot.outside_work;
  impl_->obstacle_time = snapshot.obstacle_time.value_or(snapshot.state.time);
  *impl_->pins = Pins(impl_->model.pins, impl_->start.q);
  impl_->has_previous = impl_->needs_previous() && snapshot.previous;
  if (impl_->has_previous) impl_->previous = *snapshot.previous;
  impl_->ledger.begin(impl_->model, impl_->state.q);
  impl_->measure_start();
  impl_->set_time(impl_->state.time);  // restores moving targets
  impl_->has_stepped = false;
}

}  // namespace aspic
