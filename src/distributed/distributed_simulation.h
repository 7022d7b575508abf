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

class DistributedSimulation {
 public:
  // `start`: on rank 0 the snapshot from which the simulation continues; ignored on other ranks. Throws InvalidInput on
  // all ranks if there are more ranks than vertices.
  DistributedSimulation(const WholeProblem& whole, const Simulation::Snapshot& start);
  ~DistributedSimulation();

  // Advances by one time step. The report is that of the whole model, but for the hash of the state.
  StepReport step(const IterationObserver& observe = {});
  // Returns the snapshot of the whole model on rank 0; an empty one on other ranks.
  Simulation::Snapshot gather() const;

  int steps_taken() const { return simulation_->steps_taken(); }
  std::string solver_description() const { return simulation_->solver_description(); }
  const MeshShare& share() const { return share_; }
  const Simulation& simulation() const { return *simulation_; }  // of the local vertices
  // Returns whether the ghosts of all ranks have the bits of their owners.
  bool has_equal_ghosts() const;

 private:
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
