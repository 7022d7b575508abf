#include "scene/recorded_motion.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/pc2.h"

namespace aspic {
namespace {

constexpr double kMostBytes = 1 << 30;  // of a recording in memory

struct Recording {
  std::vector<double> time;               // of each sample, ascending [s]
  std::vector<std::vector<Vec3d>> place;  // of each sample: the points [m]
};

Recording read(const std::filesystem::path& path, double fps, const AffineMap& place) {
  Pc2Reader cache(path);
  if (cache.samples() == 0) throw InvalidInput("the cache has no samples");
  if (24.0 * cache.points() * cache.samples() > kMostBytes)
    throw InvalidInput(std::to_string(cache.samples()) + " samples of " + std::to_string(cache.points()) +
                       " points exceed 1 GiB; record fewer");
  Recording recording;
  for (int k = 0; k < cache.samples(); ++k) {
    const std::vector<float> x = cache.sample(k);
    std::vector<Vec3d>& points = recording.place.emplace_back();
    for (size_t i = 0; i < x.size(); i += 3) {
      const Vec3d at = place({{x[i], x[i + 1], x[i + 2]}});
      if (!std::isfinite(at[0] + at[1] + at[2]))
        throw InvalidInput("point " + std::to_string(i / 3) + " of sample " + std::to_string(k) + " is not finite");
      points.push_back(at);
    }
    recording.time.push_back(cache.frame(k) / fps);
  }
  return recording;
}

// The points in `kept` at a time.
void interpolate(const Recording& recording, std::span<const int> kept, double time, std::span<Vec3d> x) {
  const auto& at = recording.time;
  const size_t next = std::upper_bound(at.begin(), at.end(), time) - at.begin();
  const size_t k = next == 0 ? 0 : next - 1, l = std::min(next, at.size() - 1);
  const double share = l > k ? (time - at[k]) / (at[l] - at[k]) : 0;
  for (size_t i = 0; i < kept.size(); ++i) {
    const Vec3d &a = recording.place[k][kept[i]], &b = recording.place[l][kept[i]];
    x[i] = a + share * (b - a);
  }
}

// The vertices that ContactMesh::add() keeps.
std::vector<int> used_vertices(const TriMesh& surface) {
  std::vector<char> is_used(surface.vertices.size());
  for (const Triangle& t : surface.triangles)
    for (const int v : t) is_used[v] = 1;
  std::vector<int> kept;
  for (size_t v = 0; v < is_used.size(); ++v)
    if (is_used[v]) kept.push_back(static_cast<int>(v));
  return kept;
}

}  // namespace

ObstacleMotion recorded_motion(Value& obstacle, const AffineMap& place, SceneFiles& files, TriMesh& surface) {
  Value& given = *obstacle.table().find("recording");
  const Value file = given["file"];
  const std::filesystem::path path = files.find(file);
  try {
    const auto recording = std::make_shared<const Recording>(read(path, given["fps"].number(), place));
    if (recording->place[0].size() != surface.vertices.size())
      throw InvalidInput(std::to_string(recording->place[0].size()) + " points, but the mesh has " +
                         std::to_string(surface.vertices.size()) + " vertices");
    check_fingerprint(given.table(), "hash", fingerprint_of_file(path), path.string());
    given.table().set("file", {files.keep(path, obstacle["name"].text()), {}});
    std::vector<int> all(surface.vertices.size());
    for (size_t v = 0; v < all.size(); ++v) all[v] = static_cast<int>(v);
    interpolate(*recording, all, 0, surface.vertices);
    return [recording, kept = used_vertices(surface)](double time, std::span<const Vec3d>, std::span<Vec3d> x) {
      interpolate(*recording, kept, time, x);
    };
  } catch (const InvalidInput& e) {
    throw error_at(file.place, std::string("file = ") + toml_string(file.text()) + ": " + e.what());
  }
}

}  // namespace aspic
