// The results of a run in one directory, readable by ParaView, Blender and spreadsheets at any time.
#pragma once
#include <memory>

#include "scene/scene.h"

namespace aspic {

enum class ExistingRun { refuse, overwrite };  // how create() treats an earlier run

class RunDirectory {
 public:
  // Creates the directory with scene.toml, frame 0 and the indices. Throws InvalidInput if it exists (`overwrite`
  // removes the files of a run first) or cannot be written.
  static RunDirectory create(const std::string& path, const Scene& scene, ExistingRun existing);
  // Continues an earlier run: restores the simulation from the newest readable checkpoint and removes later frames.
  // Throws InvalidInput if there is no run to continue.
  static RunDirectory resume(const std::string& path, Scene& scene);
  ~RunDirectory();
  RunDirectory(RunDirectory&&) noexcept;

  // Append to the files of the run. Throw InvalidInput if one cannot be written.
  void on_iteration(int step, const Iteration& iteration);               // iterations.csv
  void on_step(const StepReport& report, const Simulation& simulation);  // steps.csv, frames, checkpoint
  void finish(const Simulation& simulation);                             // last checkpoint, indices, closes files

  bool is_frame_due(double time) const;            // whether on_step() writes a frame at this time [s]
  std::string path() const;                        // of the directory
  std::string trace_folder(int first_step) const;  // folder of a trace that begins after the step

 private:
  struct Impl;
  explicit RunDirectory(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Returns the path of the resolved scene of a run directory, which resume() needs.
std::string scene_of_run(const std::string& run);

}  // namespace aspic
