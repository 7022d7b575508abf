// PC2 point caches, as Blender's mesh cache modifier reads them: positions of a mesh with constant topology over time.
// Layout, little-endian: "POINTCACHE2\0", int32 version 1, int32 points, float32 start, float32 rate, int32 samples;
// then for each sample float32 x y z of every point.
#pragma once
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

#include "io/checksum.h"
#include "io/output_file.h"

namespace aspic {

class Pc2File {
 public:
  static Pc2File create(const std::filesystem::path& path, int points);
  // Continues a cache after its first `samples`; removes later ones. Throws InvalidInput if it has fewer samples or
  // another number of points.
  static Pc2File resume(const std::filesystem::path& path, int points, int samples);

  // Appends positions, 3 per point [m], rounded to float32. The header counts a sample only after it is complete, so
  // that a killed run leaves a valid file.
  void append(std::span<const double> x);
  std::vector<float> sample(int index) const;  // positions of a sample, 3 per point [m]
  int samples() const { return samples_; }
  int points() const { return points_; }
  uint32_t checksum() const { return checksum_.value(); }  // of all samples
  void sync() { file_.sync(); }
  void close() { file_.close(); }

 private:
  uint64_t sample_size() const { return 12 * static_cast<uint64_t>(points_); }
  void write_count();

  OutputFile file_;
  Checksum checksum_;
  int points_ = 0, samples_ = 0;
};

// Reads a cache that another process may be writing.
class Pc2Reader {
 public:
  explicit Pc2Reader(const std::filesystem::path& path);  // throws InvalidInput if it is not a point cache

  int points() const { return points_; }
  int samples() const { return samples_; }
  double frame(int sample) const { return start_ + sample * rate_; }  // frame of the sample
  std::vector<float> sample(int index);  // 3 per point [m]; throws InvalidInput if it cannot be read

 private:
  std::filesystem::path path_;
  std::ifstream in_;
  int points_ = 0, samples_ = 0;
  float start_ = 0, rate_ = 1;
};

}  // namespace aspic
