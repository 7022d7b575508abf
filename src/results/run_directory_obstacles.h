// Obstacles in a run directory.
#pragma once
#include "contact/obstacle_surface.h"
#include "results/run_directory_layout.h"
#include "scene/scene.h"

namespace aspic {

class RunObstacles {
 public:
  RunObstacles(const RunLayout& layout, const Scene& scene);  // the scene must outlive this

  // Writes obstacles/obstacles.vtu with all obstacles if none moves, and an OBJ file of each that rests if surfaces of
  // bodies are wanted. Moving ones have such a file besides point caches only.
  void write_start() const;
  // If an obstacle moves, writes all of them to a VTU file of the frame, and the moving ones to OBJ files if surfaces
  // of bodies are wanted. `time`: of the obstacles [s].
  void add_frame(int frame, double time);
  std::vector<std::filesystem::path> files_of_frame(int frame) const;  // those of add_frame()
  // The VTU file of a frame relative to the run's folder; empty: there are no obstacles.
  std::string file_of(int frame) const;

  const std::vector<ObstacleSurface>& at_start() const { return start_; }
  TriMesh at_frame(size_t obstacle, int frame) const;

  std::vector<double> times;  // of the obstacles in each frame [s]

 private:
  bool has_motion() const;
  void write_vtu(const std::string& file, const std::vector<ObstacleSurface>& obstacles) const;

  RunLayout layout_;
  OutputOptions output_;
  const Barrier* contact_;               // null: there is none
  std::vector<ObstacleSurface> start_;   // at time 0
  std::vector<std::string> file_names_;  // of the obstacles
};

}  // namespace aspic
