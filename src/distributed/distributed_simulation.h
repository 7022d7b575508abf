// A simulation on several ranks. Every function is collective: all ranks call it in the same order.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "distributed/halo.h"
#include "distributed/mpi_ranks.h"
#include "dynamics/simulation.h"

namespace aspic::distributed {

class PetscSolver;

// The whole problem, equal on all ranks.
struct WholeProblem {
  const Model& model;                  // only used by the constructor
  std::vector<std::string> materials;  // names, one per body
  SimulationOptions options;
};

// Throws InvalidInput if there are more ranks than vertices. Not collective.
void require_vertex_per_rank(const TetMesh& mesh);

class DistributedSimulation {
 public:
  // `start`: on rank 0 the snapshot from which the simulation continues; ignored on other ranks. Requires a vertex per
  // rank.
  DistributedSimulation(const WholeProblem& whole, const Simulation::Snapshot& start);
  ~DistributedSimulation();

  // Advances by one time step. The report is that of the whole model, except for the hash of the state. Throws
  // std::runtime_error on all ranks if copies of vertices differ, which would be a defect of this program.
  StepReport step(const IterationObserver& observe = {});
  // Returns the snapshot of the whole model on rank 0; an empty one on other ranks.
  Simulation::Snapshot gather() const;

  int steps_taken() const { return simulation_->steps_taken(); }
  std::string solver_description() const { return simulation_->solver_description(); }

 private:
  bool has_equal_ghosts() const;  // whether the ghosts of all ranks have the bits of their owners
  void make_solver(const SolverOptions& options);

  MeshShare share_;
  std::unique_ptr<MpiRanks> ranks_;
  Share of_model_;
  std::unique_ptr<Halo> halo_;
  std::unique_ptr<Simulation> simulation_;
  PetscSolver* petsc_ = nullptr;  // null: conjugate gradients with block-Jacobi
  int whole_tets_ = 0;
};

}  // namespace aspic::distributed
