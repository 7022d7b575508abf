#include "ranks/distributed_simulation.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <utility>

#include "dynamics/pins.h"
#include "dynamics/simulation_checks.h"
#include "optimize/newton.h"
#include "ranks/guarded.h"
#include "ranks/petsc_solver.h"
#include "ranks/rank_auto.h"
#include "ranks/rank_cg.h"
#include "scene/scene_builder.h"

namespace aspic::distributed {
namespace {

// Iterative solves depend on the number of ranks. At small tolerances they are accurate enough that Newton counts do
// not.
SimulationOptions with_accurate_solves(SimulationOptions options) {
  MinimizeOptions& minimize = options.solver.minimize;
  minimize.max_forcing = std::min(minimize.max_forcing, std::max(1e-6, 1e4 * minimize.tolerance));
  return options;
}

// What the constructor of Simulation would check on one rank alone.
void require_mass_here(const LocalModel& local, const SimulationOptions& options) {
  all_succeed([&] {
    const bool is_finite =
        std::all_of(local.start.q.begin(), local.start.q.end(), [](double x) { return std::isfinite(x); });
    if (!is_finite) throw InvalidInput("the initial positions are not finite");
    if (options.integrator != "quasi_static") require_mass(local.model, Pins(local.model.pins, local.start.q));
  });
}

}  // namespace

DistributedSimulation::DistributedSimulation(RankScene scene, Table document, SceneFiles files)
    : share_(scene.share),
      halo_(std::make_unique<Halo>(share_)),
      ranks_(std::make_unique<MpiRanks>(share_, *halo_)),
      of_model_(*ranks_, share_.first(), share_.own()),
      user_order_(std::make_unique<UserOrder>(share_)) {
  SimulationOptions options;
  all_succeed([&] { options = simulation_options(document, notes_); });
  LocalModel local = make_local_model({scene, document, std::move(files)}, of_model_);
  notes_.insert(notes_.end(), local.notes.begin(), local.notes.end());
  scene = {};
  require_mass_here(local, options);
  make_simulation(std::move(local), with_accurate_solves(options));
  make_solver(options.solver);
}

// All ranks fail together, because terms have the values of the whole model.
void DistributedSimulation::make_simulation(LocalModel local, const SimulationOptions& options) {
  std::exception_ptr failure;
  try {
    simulation_ = std::make_unique<Simulation>(std::move(local.model), std::move(local.start), options);
  } catch (const BadInitialState& e) {
    failure = std::make_exception_ptr(BadInitialState(
        e.kind, "the initial shape has infinite energy: tets are inverted or flat", remedy_in_scene(e.kind)));
  } catch (const InvalidInput&) {
    failure = std::current_exception();
  }
  all_succeed([&] {
    if (failure) std::rethrow_exception(failure);
  });
}

DistributedSimulation::~DistributedSimulation() = default;

void DistributedSimulation::make_solver(const SolverOptions& options) {
  std::unique_ptr<LinearSolver> solver;
  if (options.linear == "block_jacobi") {
    solver = std::make_unique<RankCg>(of_model_, *halo_);
  } else if (options.linear == "auto") {
    auto chosen = std::make_unique<RankAuto>(share_, of_model_, *halo_);
    set_positions_ = [solver = chosen.get()](std::span<const double> x) { solver->set_positions(x); };
    solver = std::move(chosen);
  } else {
    auto gamg = std::make_unique<PetscSolver>(share_, of_model_, *halo_);
    set_positions_ = [solver = gamg.get()](std::span<const double> x) { solver->set_positions(x); };
    solver = std::move(gamg);
  }
  simulation_->set_direction(std::make_unique<Newton>(std::move(solver), definiteness_of(options)));
}

StepReport DistributedSimulation::step(const IterationObserver& observe) {
  if (set_positions_) set_positions_(simulation_->state().q);
  StepReport report = simulation_->step(observe);
  if (!has_equal_ghosts()) throw std::runtime_error("copies of vertices differ between ranks");
  complete(report);
  return report;
}

StepReport DistributedSimulation::start_report() {
  StepReport report = simulation_->start_report();
  complete(report);
  return report;
}

void DistributedSimulation::complete(StepReport& report) {
  report.state_hash = state_hash();
  const BodyRange& last = share_.of_bodies.back();
  report.elements = last.first_tet + last.tet_count;
}

void DistributedSimulation::restore(Simulation::Snapshot own) {
  add_ghosts(own.state);
  add_ghosts(own.start);
  if (own.previous) add_ghosts(*own.previous);
  simulation_->restore(own);
}

void DistributedSimulation::add_ghosts(State& own) {
  for (std::vector<double>* values : {&own.q, &own.qdot}) {
    values->resize(3 * static_cast<size_t>(share_.local_vertices()));
    halo_->update(*values);
  }
}

std::uint64_t DistributedSimulation::state_hash() {
  const State& state = simulation_->state();
  const std::vector<double> q = user_order_->to_user(state.q);
  return hash_of_slices(q, user_order_->to_user(state.qdot));
}

NamedPlace DistributedSimulation::place_of(int whole_vertex) {
  double numbers[4] = {};
  if (share_.owns(whole_vertex)) {
    const int v = whole_vertex - share_.first();
    for (int r = 0; r < 3; ++r) numbers[r] = simulation_->state().q[3 * static_cast<size_t>(v) + r];
    numbers[3] = share_.user_vertex[v];
  }
  of_model_.sum(numbers);
  return {static_cast<int>(numbers[3]), {{numbers[0], numbers[1], numbers[2]}}};
}

bool DistributedSimulation::has_equal_ghosts() {
  std::vector<double> q = simulation_->state().q;
  halo_->update(q);
  return of_model_.all(q == simulation_->state().q);
}

}  // namespace aspic::distributed
