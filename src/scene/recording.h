// Recorded positions of the points of a surface: PC2 point caches and animations of glTF files.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene/placement.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic {

// Positions are interpolated linearly between samples and constant before and after.
struct Recording {
  std::vector<double> time;               // of each sample, ascending [s]
  std::vector<std::vector<Vec3d>> place;  // of each sample: the points [m]

  // Writes the positions of some points at a time.
  void interpolate(std::span<const int> points, double time, std::span<Vec3d> x) const;
};

// Reads the `file` of a table, adds it to the results as `stem`, and checks its hash. `place`: applied to all
// samples. Throws InvalidInput if it does not have as many points as `surface` vertices.
std::shared_ptr<const Recording> read_recording(Table& table, const AffineMap& place, size_t vertices,
                                                SceneFiles& files, const std::string& stem);

}  // namespace aspic
