#include "scene/recording.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/pc2.h"

namespace aspic {
namespace {

constexpr double kMaxBytes = 1 << 30;  // of a recording in memory

Recording read(const std::filesystem::path& path, double fps, const AffineMap& place) {
  Pc2Reader cache(path);
  if (cache.samples() == 0) throw InvalidInput("the cache has no samples");
  if (24.0 * cache.points() * cache.samples() > kMaxBytes)
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
    auto recording = std::make_shared<const Recording>(read(path, table.find("fps")->number(), place));
    if (recording->place[0].size() != vertices)
      throw InvalidInput(std::to_string(recording->place[0].size()) + " points, but the mesh has " +
                         std::to_string(vertices) + " vertices");
    check_fingerprint(table, "hash", fingerprint_of_file(path), path.string());
    table.set("file", {files.keep(path, stem), {}});
    return recording;
  } catch (const InvalidInput& e) {
    throw error_at(file.place, std::string("file = ") + toml_string(file.text()) + ": " + e.what());
  }
}

}  // namespace aspic
