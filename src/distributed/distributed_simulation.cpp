#include "distributed/distributed_simulation.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "base/error.h"
#include "distributed/petsc_solver.h"
#include "distributed/rank_cg.h"
#include "distributed/share_model.h"
#include "optimize/newton.h"

namespace aspic::distributed {
namespace {

// Returns the state of rank 0 on all ranks, for the local vertices.
State scatter(const State& whole, const MeshShare& share) {
  State local;
  std::vector<double> values(3 * static_cast<size_t>(share.cut.back()));
  for (const auto& [from, to] : {std::pair{&whole.q, &local.q}, std::pair{&whole.qdot, &local.qdot}}) {
    if (share.rank == 0) values = *from;
    broadcast(values);
    *to = local_part(values, share);
  }
  local.time = whole.time;
  broadcast({&local.time, 1});
  return local;
}

Simulation::Snapshot scatter(const Simulation::Snapshot& whole, const MeshShare& share) {
  std::array<double, 3> numbers = {static_cast<double>(whole.steps_taken), whole.obstacle_time.value_or(0),
                                   whole.previous ? 1.0 : 0.0};
  broadcast(numbers);
  Simulation::Snapshot local;
  local.state = scatter(whole.state, share);
  local.start = scatter(whole.start, share);
  local.steps_taken = static_cast<int>(numbers[0]);
  local.obstacle_time = numbers[1];
  if (numbers[2] > 0) local.previous = scatter(whole.previous ? *whole.previous : State{}, share);
  return local;
}

// Iterative solves depend on the number of ranks. At small tolerances they are accurate enough that Newton counts do
// not.
SimulationOptions with_accurate_solves(SimulationOptions options) {
  MinimizeOptions& minimize = options.solver.minimize;
  minimize.max_forcing = std::min(minimize.max_forcing, std::max(1e-6, 1e4 * minimize.tolerance));
  return options;
}

}  // namespace

void require_vertex_per_rank(const TetMesh& mesh) {
  if (mesh.vertex_count() < rank_count())
    throw InvalidInput("the scene has " + std::to_string(mesh.vertex_count()) + " vertices for " +
                       std::to_string(rank_count()) + " ranks; use fewer ranks");
}

DistributedSimulation::DistributedSimulation(const WholeProblem& whole, const Simulation::Snapshot& start)
    : share_(make_mesh_share(whole.model.mesh, whole.model.bodies, rank_of_this_process(), rank_count())),
      ranks_(std::make_unique<MpiRanks>(whole.model.mesh, share_)),
      of_model_(*ranks_, share_.first(), share_.own()),
      halo_(std::make_unique<Halo>(share_)),
      whole_tets_(whole.model.mesh.tet_count()) {
  const Simulation::Snapshot local = scatter(start, share_);
  simulation_ = std::make_unique<Simulation>(share_model(whole.model, whole.materials, share_, *ranks_), local.start,
                                             with_accurate_solves(whole.options));
  simulation_->restore(local);
  make_solver(whole.options.solver);
}

DistributedSimulation::~DistributedSimulation() = default;

void DistributedSimulation::make_solver(const SolverOptions& options) {
  std::unique_ptr<LinearSolver> solver;
  if (options.linear == "block_jacobi") {
    solver = std::make_unique<RankCg>(of_model_, *halo_);
  } else {
    auto petsc = std::make_unique<PetscSolver>(share_, of_model_, *halo_);
    petsc_ = petsc.get();
    solver = std::move(petsc);
  }
  simulation_->set_direction(std::make_unique<Newton>(std::move(solver), definiteness_of(options)));
}

StepReport DistributedSimulation::step(const IterationObserver& observe) {
  if (petsc_) petsc_->set_positions(simulation_->state().q);
  StepReport report = simulation_->step(observe);
  if (!has_equal_ghosts()) throw std::runtime_error("copies of vertices differ between ranks");
  report.elements = whole_tets_;
  return report;
}

Simulation::Snapshot DistributedSimulation::gather() const {
  const Simulation::Snapshot local = simulation_->snapshot();
  Simulation::Snapshot whole = local;
  const auto gather_state = [this](const State& from, State& to) {
    to.q = gather_vertices(share_, from.q);
    to.qdot = gather_vertices(share_, from.qdot);
  };
  gather_state(local.state, whole.state);
  gather_state(local.start, whole.start);
  if (local.previous) gather_state(*local.previous, *whole.previous);
  return whole;
}

bool DistributedSimulation::has_equal_ghosts() const {
  std::vector<double> q = simulation_->state().q;
  halo_->update(q);
  return of_model_.all(q == simulation_->state().q);
}

}  // namespace aspic::distributed
