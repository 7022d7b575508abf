#include "io/pc2.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <string>

#include "base/check.h"
#include "base/error.h"
#include "io/input_file.h"
#include "io/number_text.h"

namespace aspic {
namespace {

constexpr std::string_view kPc2Magic("POINTCACHE2\0", 12);
constexpr uint64_t kPc2HeadSize = 32, kPointsOffset = 16, kStartOffset = 20, kRateOffset = 24, kCountOffset = 28;

std::string head(int points, int samples) {
  std::string bytes(kPc2Magic);
  append_bytes(bytes, int32_t{1});
  append_bytes(bytes, static_cast<int32_t>(points));
  append_bytes(bytes, 0.0f);  // start [frames]
  append_bytes(bytes, 1.0f);  // rate [frames per sample]
  append_bytes(bytes, static_cast<int32_t>(samples));
  return bytes;
}

std::string bytes_at(const std::filesystem::path& path, uint64_t offset, uint64_t size) {
  std::ifstream in = open_input(path);
  std::string bytes(size, '\0');
  in.seekg(static_cast<std::streamoff>(offset));
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!in) throw InvalidInput(path.string() + ": cannot be read: the point cache is cut short");
  return bytes;
}

}  // namespace

Pc2File Pc2File::create(const std::filesystem::path& path, int points) {
  Pc2File cache;
  cache.file_ = OutputFile::create(path);
  cache.file_.append(head(points, 0));
  cache.points_ = points;
  return cache;
}

Pc2File Pc2File::resume(const std::filesystem::path& path, int points, int samples) {
  Pc2File cache;
  cache.file_ = OutputFile::open_existing(path);
  cache.points_ = points;
  cache.samples_ = samples;
  if (cache.file_.size() < kPc2HeadSize || bytes_at(path, 0, kCountOffset) != head(points, 0).substr(0, kCountOffset)) {
    throw InvalidInput(path.string() + ": is not a point cache of " + std::to_string(points) + " points");
  }
  const uint64_t size = kPc2HeadSize + static_cast<uint64_t>(samples) * cache.sample_size();
  if (cache.file_.size() < size) {
    throw InvalidInput(path.string() + ": holds fewer than the " + std::to_string(samples) +
                       " samples of the checkpoint; the run cannot be continued");
  }
  cache.write_count();  // first, so that the header never counts truncated samples
  cache.file_.truncate(size);
  cache.checksum_ = file_checksum(path, kPc2HeadSize, size);
  return cache;
}

void Pc2File::append(std::span<const double> x) {
  ASPIC_CHECK(x.size() == 3 * static_cast<size_t>(points_));
  std::string bytes;
  bytes.reserve(sample_size());
  for (const double coordinate : x) append_bytes(bytes, static_cast<float>(coordinate));
  file_.append(bytes);
  checksum_.add(bytes);
  ++samples_;
  write_count();
}

std::vector<float> Pc2File::sample(int index) const {
  ASPIC_CHECK(index >= 0 && index < samples_);
  const std::string bytes =
      bytes_at(file_.path(), kPc2HeadSize + static_cast<uint64_t>(index) * sample_size(), sample_size());
  std::vector<float> x(3 * static_cast<size_t>(points_));
  std::memcpy(x.data(), bytes.data(), bytes.size());
  return x;
}

void Pc2File::write_count() {
  std::string count;
  append_bytes(count, static_cast<int32_t>(samples_));
  file_.write_at(kCountOffset, count);
}

Pc2Reader::Pc2Reader(const std::filesystem::path& path) : path_(path), in_(open_input(path)) {
  std::string bytes(kPc2HeadSize, '\0');
  in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in_) throw InvalidInput(path.string() + ": cannot be read, or is too short for a point cache");
  const auto read = [&](size_t at, auto& value) { std::memcpy(&value, bytes.data() + at, sizeof(value)); };
  read(kPointsOffset, points_);
  read(kStartOffset, start_);
  read(kRateOffset, rate_);
  read(kCountOffset, samples_);
  if (points_ < 0 || samples_ < 0 || !bytes.starts_with(head(points_, 0).substr(0, kStartOffset)) ||
      !std::isfinite(start_) || !(rate_ > 0 && std::isfinite(rate_)))
    throw InvalidInput(path.string() + ": is not a point cache of version 1");
  if (points_ == 0 && samples_ > 0)
    throw InvalidInput(path.string() + ": the point cache states " + std::to_string(samples_) +
                       " samples of 0 points; export it again with the points of the mesh");
  in_.seekg(0, std::ios::end);
  const uint64_t whole = in_ ? (static_cast<uint64_t>(in_.tellg()) - kPc2HeadSize) / 12 : 0;  // points of all samples
  if (static_cast<uint64_t>(points_) * static_cast<uint64_t>(samples_) > whole)
    throw InvalidInput(path.string() + ": the point cache is cut short: its header states " + std::to_string(samples_) +
                       " samples of " + std::to_string(points_) + " points");
}

std::vector<float> Pc2Reader::sample(int index) {
  ASPIC_CHECK(index >= 0 && index < samples_);
  std::vector<float> x(3 * static_cast<size_t>(points_));
  in_.seekg(static_cast<std::streamoff>(kPc2HeadSize + 4 * x.size() * static_cast<uint64_t>(index)));
  in_.read(reinterpret_cast<char*>(x.data()), static_cast<std::streamsize>(4 * x.size()));
  if (!in_) throw InvalidInput(path_.string() + ": sample " + std::to_string(index) + " cannot be read");
  return x;
}

}  // namespace aspic
