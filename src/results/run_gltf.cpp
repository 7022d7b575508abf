#include "results/run_gltf.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "io/checkpoint.h"
#include "io/gltf.h"
#include "io/pc2.h"
#include "io/usd.h"
#include "io/vertex_merger.h"
#include "results/run_directory_obstacles.h"

namespace aspic {
namespace {

constexpr int kMaxFrames = 240;       // more morph targets are slow in all programs that read them
constexpr double kLargestFile = 1e9;  // maximum estimated size

std::vector<float> numbers_of(const std::vector<Vec3d>& points) {
  std::vector<float> numbers;
  for (const Vec3d& x : points) numbers.insert(numbers.end(), x.a, x.a + 3);
  return numbers;
}

// A skin whose vertices are split where texture coordinates differ.
struct SplitSkin {
  std::vector<Vec3d> vertices;  // (number in the skin, u, v)
  std::vector<Triangle> triangles;

  explicit SplitSkin(const Skin& skin) : triangles(skin.rest.triangles) {
    if (skin.uv.empty())
      for (int v = 0; v < skin.rest.vertex_count(); ++v) vertices.push_back({{1.0 * v, 0, 0}});
    VertexMerger merger;
    for (size_t t = 0; t < skin.uv.size(); ++t)
      for (size_t c = 0; c < 3; ++c) {
        const auto& [u, v] = skin.uv[t][c];
        triangles[t][c] = merger.vertex({{1.0 * triangles[t][c], u, v}}, vertices);
      }
  }
  // Returns the points from those of the skin.
  std::vector<float> points(const std::vector<float>& x) const {
    std::vector<float> own;
    for (const Vec3d& vertex : vertices) {
      const auto from = x.begin() + 3 * static_cast<std::ptrdiff_t>(vertex[0]);
      own.insert(own.end(), from, from + 3);
    }
    return own;
  }
  // Returns the texture coordinates with v downward, as in glTF.
  std::vector<float> uv() const {
    std::vector<float> own;
    for (const Vec3d& vertex : vertices)
      own.insert(own.end(), {static_cast<float>(vertex[1]), static_cast<float>(1 - vertex[2])});
    return own;
  }
};

// The frames of a skin, from its point cache.
class SkinFrames {
 public:
  SkinFrames(const RunLayout& layout, const std::string& name, const Skin& skin, int frames)
      : file_(layout.skin_cache(name)), cache_(file_) {
    if (cache_.points() != skin.rest.vertex_count() || cache_.samples() < frames)
      throw InvalidInput(file_.string() + ": holds " + std::to_string(cache_.samples()) + " samples of " +
                         std::to_string(cache_.points()) + " points; the run has " + std::to_string(frames) +
                         " frames of " + std::to_string(skin.rest.vertex_count()));
  }
  std::vector<float> at(int frame) {
    std::vector<float> points = cache_.sample(frame);
    for (const float x : points)
      if (!std::isfinite(x))
        throw InvalidInput(file_.string() + ": a point of sample " + std::to_string(frame) +
                           " is not finite; run the scene again with a shorter time step");
    return points;
  }

 private:
  std::filesystem::path file_;
  Pc2Reader cache_;
};

std::vector<int> chosen_frames(int frames, const std::vector<SplitSkin>& skins) {
  double bytes = 0;  // per frame
  for (const SplitSkin& skin : skins) bytes += 12.0 * static_cast<double>(skin.vertices.size());
  const int most = std::max(2, static_cast<int>(std::min<double>(kMaxFrames, kLargestFile / std::max(bytes, 1.0))));
  const int stride = std::max(1, (frames - 1 + most - 2) / (most - 1));
  std::vector<int> chosen;
  for (int k = 0; k < frames; k += stride) chosen.push_back(k);
  if (chosen.back() != frames - 1) chosen.push_back(frames - 1);
  return chosen;
}

// Turns the z axis to the y axis, which is up in glTF.
void turn_upright(std::vector<float>& points) {
  for (size_t i = 0; i + 2 < points.size(); i += 3) points[i + 1] = std::exchange(points[i + 2], -points[i + 1]);
}

}  // namespace

RunGltf run_glb(const RunLayout& layout, const Scene& scene) {
  const Checkpoint checkpoint = read_newest_checkpoint(layout.checkpoint()).checkpoint;
  const std::vector<double>& times = checkpoint.array("frame_times");
  const int frames = static_cast<int>(times.size());
  std::error_code error;
  if (frames == 0 || scene.skins.empty() || !std::filesystem::exists(layout.skins(), error))
    throw InvalidInput(layout.root().string() + ": holds no point caches; run it again with output.pc2 = true");
  std::vector<SplitSkin> split(scene.skins.begin(), scene.skins.end());
  const std::vector<int> chosen = chosen_frames(frames, split);
  GltfScene gltf;
  for (const int k : chosen) gltf.times.push_back(times[k] - times[0]);

  std::vector<std::string> names;
  for (const Skin& skin : scene.skins) names.push_back(skin.body);
  names = file_names(names);
  for (size_t i = 0; i < scene.skins.size(); ++i) {
    const Skin& skin = scene.skins[i];
    SkinFrames skin_frames(layout, names[i], skin, frames);
    GltfMesh& mesh = gltf.meshes.emplace_back(
        GltfMesh{.name = skin.body, .triangles = split[i].triangles, .segments = skin.segments});
    if (!skin.uv.empty()) mesh.uv = split[i].uv();
    for (const int k : chosen) mesh.frames.push_back(split[i].points(skin_frames.at(k)));
  }
  RunObstacles obstacles(layout, scene);
  const std::vector<double>* obstacle_times = checkpoint.find("obstacle_times");
  obstacles.times = obstacle_times ? *obstacle_times : times;
  if (obstacles.times.size() != times.size())
    throw InvalidInput(layout.root().string() + ": the checkpoint is damaged");
  for (size_t i = 0; i < obstacles.at_start().size(); ++i) {
    const ObstacleSurface& start = obstacles.at_start()[i];
    GltfMesh& mesh = gltf.meshes.emplace_back(GltfMesh{.name = start.name, .triangles = start.surface.triangles});
    for (const int k : chosen)
      if (mesh.frames.empty() || start.is_moving) mesh.frames.push_back(numbers_of(obstacles.at_frame(i, k).vertices));
  }
  if (up_axis(scene.gravity) == UpAxis::z)
    for (GltfMesh& mesh : gltf.meshes)
      for (std::vector<float>& points : mesh.frames) turn_upright(points);
  return {glb(gltf), static_cast<int>(chosen.size()), frames};
}

}  // namespace aspic
