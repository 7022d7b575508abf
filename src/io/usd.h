// USD scene as text (.usda): one mesh or set of curves per body with points sampled over time. Lengths are in meters.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/camera.h"
#include "mesh/tet_mesh.h"
#include "mesh/triangle_uv.h"

namespace aspic {

struct UsdMesh {
  std::string name;  // becomes a USD identifier; a number makes it unique where necessary
  std::span<const Triangle> triangles;
  std::function<std::vector<float>(int sample)> points;  // 3 per vertex [m]
  bool is_fixed = false;                                 // the first sample is that of all times
  bool is_two_sided = false;
  std::span<const Segment> segments = {};  // of rods, chain by chain; not empty: BasisCurves instead of a Mesh
  double radius = 0;                       // of rods [m]
  std::span<const TriangleUv> uv = {};     // of each triangle; may be empty
};

enum class UpAxis { y, z };
// Returns z if gravity is along z, otherwise y.
UpAxis up_axis(const Vec3d& gravity);

struct UsdView {
  UpAxis up = UpAxis::y;
  std::optional<Camera> camera = {};
};

// Writes times[i] [s] as the time of sample i. A time code is time times `codes_per_second`, which should be the rate
// of the samples because players show one frame per code. Writes sample by sample, so the file may exceed memory, and
// replaces `path` atomically. Throws InvalidInput if it cannot be written.
void write_usd(const std::filesystem::path& path, const std::vector<UsdMesh>& meshes, const std::vector<double>& times,
               double codes_per_second, const UsdView& view = {});

}  // namespace aspic
