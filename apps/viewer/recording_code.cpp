#include "viewer/recording_code.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/number_text.h"
#include "viewer/scene_json.h"

namespace aspic::viewer {
namespace {

constexpr double kLargestCode = 65535, kLargestValue = 254;
constexpr uint8_t kCodeOfNoNumber = 255;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void pad(std::string& bytes) { bytes.append((4 - bytes.size() % 4) % 4, '\0'); }

uint16_t folded(int difference) {
  const auto small = static_cast<int16_t>(static_cast<uint16_t>(difference));
  return static_cast<uint16_t>((static_cast<uint32_t>(small) << 1) ^ static_cast<uint32_t>(small >> 15));
}

}  // namespace

void ArrayPack::add_bytes(const std::string& name, const char* type, const void* data, size_t count, size_t size) {
  list_.push_back({{"name", name}, {"type", type}, {"at", bytes_.size()}, {"count", count}});
  bytes_.append(static_cast<const char*>(data), count * size);
  pad(bytes_);
}

void ArrayPack::add(const std::string& name, const std::vector<float>& numbers) {
  add_bytes(name, "f32", numbers.data(), numbers.size(), sizeof(float));
}
void ArrayPack::add(const std::string& name, const std::vector<uint32_t>& numbers) {
  add_bytes(name, "u32", numbers.data(), numbers.size(), sizeof(uint32_t));
}
void ArrayPack::add(const std::string& name, const std::vector<uint8_t>& numbers) {
  add_bytes(name, "u8", numbers.data(), numbers.size(), sizeof(uint8_t));
}

std::string ArrayPack::bytes(Json head) const {
  head["arrays"] = list_;
  // Replaces invalid UTF-8, such as that of a file name.
  const std::string json = head.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string bytes;
  append_bytes(bytes, static_cast<uint32_t>(json.size()));
  bytes += json;
  pad(bytes);
  return bytes + bytes_;
}

PositionRange::PositionRange(std::span<const float> first) {
  constexpr double kBlownUp = 1000;
  const Box box = box_of(first);
  lower = box.lower;
  upper = box.upper;
  largest_ = kBlownUp * longest_side(box);
}

void PositionRange::add(std::span<const float> x) {
  const Box box = box_of(x);
  if (largest_ > 0 && !(longest_side(box) <= largest_)) return;
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = std::min(lower[axis], box.lower[axis]);
    upper[axis] = std::max(upper[axis], box.upper[axis]);
  }
}

void PositionCode::add(std::span<const float> x) {
  const size_t n = x.size(), start = bytes_.size();
  std::vector<uint16_t> codes(n);
  bytes_.resize(start + 2 * n);
  for (size_t i = 0; i < n; ++i) {
    const int axis = static_cast<int>(i % 3);
    const double size = range_.size()[axis];
    const double code = size > 0 ? kLargestCode * ((x[i] - range_.lower[axis]) / size) : 0;
    codes[i] = static_cast<uint16_t>(std::lround(std::clamp(code, 0.0, kLargestCode)));
    const int before = last_.empty() ? 0 : last_[i];
    const int earlier = before_last_.empty() ? before : before_last_[i];
    const uint16_t difference = folded(codes[i] - (2 * before - earlier));
    bytes_[start + i] = static_cast<uint8_t>(difference & 0xff);
    bytes_[start + n + i] = static_cast<uint8_t>(difference >> 8);
  }
  before_last_ = std::move(last_);
  last_ = std::move(codes);
}

ValueScale::ValueScale(std::span<const float> values) {
  min = kInfinity, max = -kInfinity;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    min = std::min(min, value);
    max = std::max(max, value);
  }
  if (min > max) min = max = 0;  // no finite value
  if (!(min < 0 && max > 0)) return;
  const double step = (double{max} - double{min}) / (kLargestValue - 1);
  const double zero = std::ceil(-double{min} / step);
  min = static_cast<float>(-zero * step);
  max = static_cast<float>((kLargestValue - zero) * step);
}

uint8_t ValueScale::code(float value) const {
  if (!std::isfinite(value)) return kCodeOfNoNumber;
  const double step = (double{max} - double{min}) / kLargestValue;
  if (!(step > 0)) return 0;
  const double code = std::round((double{value} - double{min}) / step), zero = std::round(-double{min} / step);
  const double signed_code = code == zero && value != 0 ? zero + (value > 0 ? 1 : -1) : code;
  return static_cast<uint8_t>(std::clamp(signed_code, 0.0, kLargestValue));
}

void ValueCode::add(std::span<const float> values) {
  const ValueScale scale(values);
  ranges_.push_back(scale.min);
  ranges_.push_back(scale.max);
  std::vector<uint8_t> codes;
  for (const float value : values) {
    codes.push_back(scale.code(value));
    bytes_.push_back(static_cast<uint8_t>(codes.back() - (last_.empty() ? 0 : last_[codes.size() - 1])));
  }
  last_ = std::move(codes);
}

}  // namespace aspic::viewer
