// PC2 point caches, as Blender's mesh cache modifier reads them: the moving positions of a mesh whose topology stays.
// Layout, little-endian: "POINTCACHE2\0", int32 version 1, int32 points, float32 start, float32 rate, int32 samples;
// then for each sample float32 x y z of every point.
#pragma once
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

#include "io/output_file.h"

namespace aspic {

class Pc2File {
 public:
  static Pc2File create(const std::filesystem::path& path, int points);
  // Continues a cache after its first `samples`; later ones are dropped. Throws InvalidInput when it holds fewer, or
  // another number of points.
  static Pc2File resume(const std::filesystem::path& path, int points, int samples);

  // Positions, 3 per point [m], rounded to float32. The head counts the sample only once it is complete, so that a
  // killed run leaves a valid file.
  void append(std::span<const double> x);
  std::vector<float> sample(int index) const;  // what was appended: 3 per point
  int samples() const { return samples_; }
  int points() const { return points_; }
  void sync() { file_.sync(); }
  void close() { file_.close(); }

 private:
  uint64_t sample_size() const { return 12 * static_cast<uint64_t>(points_); }
  void write_count();

  OutputFile file_;
  int points_ = 0, samples_ = 0;
};

// A cache that somebody else may be writing.
class Pc2Reader {
 public:
  explicit Pc2Reader(const std::filesystem::path& path);  // throws InvalidInput when it is no whole point cache

  int points() const { return points_; }
  int samples() const { return samples_; }
  std::vector<float> sample(int index);  // 3 per point; throws InvalidInput when it cannot be read

 private:
  std::filesystem::path path_;
  std::ifstream in_;
  int points_ = 0, samples_ = 0;
};

}  // namespace aspic
