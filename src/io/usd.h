// One USD scene as text (.usda): a mesh per body whose points are sampled over time. Y is up, units are meters.
#pragma once
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

struct UsdMesh {
  std::string name;  // becomes a USD identifier; made unique by a number where needed
  std::span<const Triangle> triangles;
  std::function<std::vector<float>(int sample)> points;  // 3 per vertex [m]
};

// times[i] [s] is that of sample i. A time code is time times `codes_per_second`; players show one frame per code, so
// it should be the rate of the samples. The file is written sample by sample, so it may be larger than memory, and
// appears at once when it is complete. Throws InvalidInput when it cannot be written.
void write_usd(const std::filesystem::path& path, const std::vector<UsdMesh>& meshes, const std::vector<double>& times,
               double codes_per_second);

}  // namespace aspic
