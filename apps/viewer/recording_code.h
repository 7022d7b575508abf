// How a recording is packed: numbers made small, then compressed. web/src/recording.ts undoes it.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "math/small.h"
#include "viewer/arguments.h"

namespace aspic::viewer {

// Arrays one after another, each at a multiple of 4 bytes, with a list of what is where.
class ArrayPack {
 public:
  void add(const std::string& name, const std::vector<float>& numbers);
  void add(const std::string& name, const std::vector<uint32_t>& numbers);
  void add(const std::string& name, const std::vector<uint8_t>& numbers);

  // u32 length of the JSON, the JSON, zeros up to a multiple of 4, the arrays. The list becomes head["arrays"].
  std::string bytes(Json head) const;

 private:
  void add_bytes(const std::string& name, const char* type, const void* data, size_t count, size_t size);

  Json list_ = Json::array();
  std::string bytes_;
};

// The box of points over all frames. Frames of a motion that blew up, more than 1000 times as large as the first, would
// leave no digits for the others: they do not count, and their points are put onto its faces.
struct PositionRange {
  Vec3d lower, upper;

  explicit PositionRange(std::span<const float> first);  // 3 numbers per point
  void add(std::span<const float> x);                    // of another frame
  Vec3d size() const { return upper - lower; }

 private:
  double largest_ = 0;  // extent of a frame that counts
};

// Positions as whole numbers 0 .. 65535 over the box, frame by frame as the difference to the straight line through
// the two frames before, modulo 65536, folded so that small differences of either sign are small; first the low bytes
// of a frame, then the high bytes.
class PositionCode {
 public:
  explicit PositionCode(const PositionRange& range) : range_(range) {}
  void add(std::span<const float> x);
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  PositionRange range_;
  std::vector<uint16_t> last_, before_last_;
  std::vector<uint8_t> bytes_;
};

// Values as whole numbers 0 .. 254 over the range of their frame, 255 for what is not finite; frame by frame as the
// difference to the frame before, modulo 256.
class ValueCode {
 public:
  void add(std::span<const float> values);
  const std::vector<uint8_t>& bytes() const { return bytes_; }
  const std::vector<float>& ranges() const { return ranges_; }  // smallest and largest of each frame

 private:
  std::vector<uint8_t> last_, bytes_;
  std::vector<float> ranges_;
};

}  // namespace aspic::viewer
