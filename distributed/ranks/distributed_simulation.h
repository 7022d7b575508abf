// A simulation on several ranks. Every function is collective unless it is const.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "ranks/halo.h"
#include "ranks/local_model.h"
#include "ranks/mpi_ranks.h"
#include "ranks/rank_scene.h"
#include "ranks/user_order.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic::distributed {

struct NamedPlace {
  int user_vertex;
  Vec3d position;
};

class DistributedSimulation {
 public:
  // `document`: the complete document of the scene, equal on all ranks. Throws Refused. Requires a vertex per rank.
  DistributedSimulation(RankScene scene, Table document, SceneFiles files);
  ~DistributedSimulation();

  // Advances by one time step. The report is that of the whole model. Throws std::runtime_error on all ranks if copies
  // of vertices differ, which would be a defect of this program.
  StepReport step(const IterationObserver& observe = {});
  StepReport start_report();  // see Simulation
  // Continues from a snapshot of the own vertices. Throws Refused.
  void restore(Simulation::Snapshot own);
  std::uint64_t state_hash();  // of the whole state

  NamedPlace place_of(int whole_vertex);

  const Simulation& local() const { return *simulation_; }  // the part of this rank
  const MeshShare& share() const { return share_; }
  const UserOrder& user_order() const { return *user_order_; }
  const LinearTraffic& linear_traffic() const { return halo_->traffic().linear; }
  const std::vector<std::string>& notes() const { return notes_; }
  int steps_taken() const { return simulation_->steps_taken(); }

 private:
  bool has_equal_ghosts();  // whether the ghosts of all ranks have the bits of their owners
  void make_solver(const SolverOptions& options);
  void make_simulation(LocalModel local, const SimulationOptions& options);
  void add_ghosts(State& own);
  void complete(StepReport& report);

  MeshShare share_;
  std::unique_ptr<Halo> halo_;
  std::unique_ptr<MpiRanks> ranks_;
  Share of_model_;
  std::unique_ptr<UserOrder> user_order_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<std::string> notes_;
  // Passes positions to the solver before each step; empty: it needs none.
  std::function<void(std::span<const double>)> set_positions_;
};

}  // namespace aspic::distributed
