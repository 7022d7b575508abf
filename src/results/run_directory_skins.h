// The skins of a run over time: point caches for Blender, mesh sequences, one USD scene.
#pragma once
#include <filesystem>
#include <span>
#include <vector>

#include "io/pc2.h"
#include "io/usd.h"
#include "results/run_directory_layout.h"
#include "results/run_directory_obstacles.h"
#include "scene/scene.h"

namespace aspic {

class RunSkins {
 public:
  static RunSkins create(const RunLayout& layout, const Scene& scene);
  static RunSkins resume(const RunLayout& layout, const Scene& scene, int frames);

  void add_frame(int frame, std::span<const double> q);                // q of the model, 3 per vertex [m]
  std::vector<std::filesystem::path> files_of_frame(int frame) const;  // besides the caches
  std::vector<double> checksums() const;                               // of the caches
  // Throws InvalidInput if a cache has not its checksum.
  void require_unchanged(const std::vector<double>& checksums) const;
  void sync();
  // Rewrites run.usda with all frames.
  void write_usd(const std::vector<double>& frame_times, const RunObstacles& obstacles);
  // Rewrites run.usda if the number of frames has doubled since, so that the total cost stays linear.
  void write_usd_when_doubled(const std::vector<double>& frame_times, const RunObstacles& obstacles);
  void close();

 private:
  RunSkins(const RunLayout& layout, const Scene& scene);

  RunLayout layout_;
  OutputOptions output_;
  std::vector<Skin> skins_;
  std::vector<std::string> names_;
  double frame_rate_;  // [1/s]
  UpAxis up_;
  std::vector<Pc2File> caches_;  // one per skin, when PC2 or USD is wanted: USD is assembled from them
  size_t frames_in_usd_ = 0;
  std::vector<double> x_;  // scratch
};

}  // namespace aspic
