// The codes of a recording: quantized numbers, then compression. web/src/recording.ts decodes them.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "math/small.h"
#include "viewer/arguments.h"

namespace aspic::viewer {

// A sequence of arrays, each at a multiple of 4 bytes, with a table of contents.
class ArrayPack {
 public:
  void add(const std::string& name, const std::vector<float>& numbers);
  void add(const std::string& name, const std::vector<uint32_t>& numbers);
  void add(const std::string& name, const std::vector<uint8_t>& numbers);

  // Returns the length of the JSON (u32), the JSON, zeros up to a multiple of 4, and the arrays. Sets head["arrays"].
  std::string bytes(Json head) const;

 private:
  void add_bytes(const std::string& name, const char* type, const void* data, size_t count, size_t size);

  Json list_ = Json::array();
  std::string bytes_;
};

// The bounding box of the points over all frames. Frames that blew up to more than 1000 times the first size are
// excluded, since they would leave no digits for the others. Their points are clamped to the box.
struct PositionRange {
  Vec3d lower, upper;

  explicit PositionRange(std::span<const float> first);  // 3 numbers per point
  void add(std::span<const float> x);                    // adds another frame
  Vec3d size() const { return upper - lower; }

 private:
  double largest_ = 0;  // largest extent of an included frame
};

// Positions as integers 0 .. 65535 over the box. Each frame stores the differences to the linear extrapolation of the
// previous two frames, modulo 65536, folded so that small differences of either sign are small. The low bytes of a
// frame precede its high bytes.
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

// The range of the values of a frame, with codes 0 .. 254 at even intervals and 255 for nonfinite values. If the range
// contains zero, one code is exactly zero, and other values keep their sign.
struct ValueScale {
  float min = 0, max = 0;

  explicit ValueScale(std::span<const float> values);
  uint8_t code(float value) const;
};

// Values as codes over the range of their frame. Each frame stores the differences to the previous frame, modulo 256.
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
