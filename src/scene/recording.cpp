#include "scene/recording.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/gltf_reader.h"
#include "io/mesh_file.h"
#include "io/pc2.h"

namespace aspic {
namespace {

constexpr double kMaxBytes = 1 << 30;  // of a recording in memory

bool is_gltf(const std::filesystem::path& path) {
  return path.extension() == ".glb" || path.extension() == ".gltf" || path.extension() == ".GLB";
}

Recording read_cache(const std::filesystem::path& path, double fps) {
  Pc2Reader cache(path);
  if (cache.samples() == 0) throw InvalidInput("the cache has no samples");
  if (24.0 * cache.points() * cache.samples() > kMaxBytes)
    throw InvalidInput(std::to_string(cache.samples()) + " samples of " + std::to_string(cache.points()) +
                       " points exceed 1 GiB; record fewer");
  Recording recording;
  for (int k = 0; k < cache.samples(); ++k) {
    const std::vector<float> x = cache.sample(k);
    std::vector<Vec3d>& points = recording.place.emplace_back();
    for (size_t i = 0; i < x.size(); i += 3) points.push_back({{x[i], x[i + 1], x[i + 2]}});
    recording.time.push_back(cache.frame(k) / fps);
  }
  return recording;
}

Recording read(const std::filesystem::path& path, const Table& table, const AffineMap& place) {
  const double fps = table.find("fps")->number();
  const Value* animation = table.find("animation");
  Recording recording;
  if (is_gltf(path)) {
    GltfMotion motion = read_gltf_motion(path, {fps, animation ? animation->text() : ""});
    recording = {std::move(motion.times), std::move(motion.vertices)};
  } else {
    if (animation) throw InvalidInput("point caches have one motion; remove `animation`");
    recording = read_cache(path, fps);
  }
  for (size_t k = 0; k < recording.place.size(); ++k)
    for (size_t i = 0; i < recording.place[k].size(); ++i) {
      Vec3d& x = recording.place[k][i];
      x = place(x);
      if (!std::isfinite(x[0] + x[1] + x[2]))
        throw InvalidInput("point " + std::to_string(i) + " of sample " + std::to_string(k) + " is not finite");
    }
  return recording;
}

}  // namespace

void Recording::interpolate(std::span<const int> points, double at, std::span<Vec3d> x) const {
  const size_t next = std::upper_bound(time.begin(), time.end(), at) - time.begin();
  const size_t k = next == 0 ? 0 : next - 1, l = std::min(next, time.size() - 1);
  const double share = l > k ? (at - time[k]) / (time[l] - time[k]) : 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3d &a = place[k][points[i]], &b = place[l][points[i]];
    x[i] = a + share * (b - a);
  }
}

std::shared_ptr<const Recording> read_recording(Table& table, const AffineMap& place, size_t vertices,
                                                SceneFiles& files, const std::string& stem) {
  const Value file = *table.find("file");
  const std::filesystem::path path = files.find(file);
  try {
    auto recording = std::make_shared<const Recording>(read(path, table, place));
    if (recording->place[0].size() != vertices)
      throw InvalidInput(std::to_string(recording->place[0].size()) + " points, but the mesh has " +
                         std::to_string(vertices) + " vertices");
    check_fingerprint(table, "hash", fingerprint_of_file(path), path.string());
    table.set("file", {files.keep(path, is_gltf(path) ? stem + "_motion" : stem), {}});
    return recording;
  } catch (const InvalidInput& e) {
    throw error_at(file.place, std::string("file = ") + toml_string(file.text()) + ": " + e.what());
  }
}

}  // namespace aspic
