// The results of a run: one directory that ParaView, Blender and a spreadsheet can open, valid at every instant.
#pragma once
#include <filesystem>
#include <memory>

#include "scene/scene.h"

namespace aspic {

enum class ExistingRun { refuse, overwrite };

class RunDirectory {
 public:
  // Creates the directory with scene.toml, frame 0 and the indices. Throws InvalidInput when it exists (unless
  // overwrite, which only ever removes files that a run writes) or cannot be written.
  static RunDirectory create(const std::filesystem::path& path, const Scene& scene, ExistingRun existing);
  // Continues an earlier run: restores the simulation from the newest readable checkpoint and drops later frames.
  static RunDirectory resume(const std::filesystem::path& path, Scene& scene);
  ~RunDirectory();
  RunDirectory(RunDirectory&&) noexcept;

  void on_iteration(int step, const Iteration& iteration);               // iterations.csv
  void on_step(const StepReport& report, const Simulation& simulation);  // steps.csv, frames, checkpoint
  void finish(const Simulation& simulation);                             // last checkpoint, indices, closes files

  const std::filesystem::path& path() const;
  std::filesystem::path trace_folder(int first_step) const;  // where a trace that begins after that step belongs

 private:
  struct Impl;
  explicit RunDirectory(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// The resolved scene of a run directory, to be loaded before resuming.
std::filesystem::path scene_of_run(const std::filesystem::path& run);

}  // namespace aspic
