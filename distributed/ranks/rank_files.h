// The run directory of a simulation on several ranks. Every function is collective.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "ranks/distributed_simulation.h"
#include "results/run_directory.h"

namespace aspic::distributed {

struct RunPlan {
  std::string path;      // of the directory
  std::string resolved;  // see Scene
  OutputOptions output;
};

class RankFiles {
 public:
  // `inputs`: used on rank 0. Throws Refused like RunDirectory::create().
  static RankFiles create(const RunPlan& plan, const SceneInputs& inputs, ExistingRun existing,
                          DistributedSimulation& simulation);
  // Restores the simulation. Throws Refused like RunDirectory::resume(). Adds notes.
  static RankFiles resume(const RunPlan& plan, DistributedSimulation& simulation, std::vector<std::string>& notes);
  ~RankFiles();
  RankFiles(RankFiles&&) noexcept;

  // Appends the step to the tables; writes a frame and a checkpoint if one is due. Throws Refused.
  void on_step(const StepReport& report, const std::vector<Iteration>& iterations,
               const DistributedSimulation& simulation);
  void finish(const DistributedSimulation& simulation);

 private:
  struct Impl;
  explicit RankFiles(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic::distributed
