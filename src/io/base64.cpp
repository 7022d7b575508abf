#include "io/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/parallel.h"
#include "io/blank.h"

namespace aspic {
namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<int8_t, 256> make_values() {
  std::array<int8_t, 256> values{};
  for (int8_t& value : values) value = -1;
  for (int i = 0; i < 64; ++i) values[static_cast<unsigned char>(kAlphabet[i])] = static_cast<int8_t>(i);
  return values;
}
constexpr std::array<int8_t, 256> kValues = make_values();

constexpr size_t encoded_size(size_t bytes) { return (bytes + 2) / 3 * 4; }

void encode(std::string_view bytes, char* digit) {
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) *digit++ = k <= count ? kAlphabet[group >> (18 - 6 * k) & 63] : '=';
  }
}

}  // namespace

void append_base64(std::string_view bytes, std::string& text) {
  constexpr size_t kPerTask = 3 << 16;
  const size_t first = text.size();
  text.resize(first + encoded_size(bytes.size()));
  parallel_for(static_cast<int>((bytes.size() + kPerTask - 1) / kPerTask), [&](int task) {
    const size_t begin = static_cast<size_t>(task) * kPerTask;
    encode(bytes.substr(begin, kPerTask), &text[first + encoded_size(begin)]);
  });
}

bool decode_base64(std::string_view& text, size_t wanted, std::string& bytes) {
  const size_t first = bytes.size();
  uint32_t group = 0;
  int digits = 0, padding = 0;
  size_t i = 0;
  for (; i < text.size() && (digits > 0 || bytes.size() - first < wanted); ++i) {
    if (is_blank(text[i])) continue;
    const int8_t value = kValues[static_cast<unsigned char>(text[i])];
    if (text[i] == '=' && digits >= 2) {
      ++padding;
    } else if (value < 0 || padding > 0) {
      return false;
    }
    group = group << 6 | static_cast<uint32_t>(value < 0 ? 0 : value);
    if (++digits < 4) continue;
    for (int k = 0; k < 3 - padding; ++k) bytes += static_cast<char>(group >> (16 - 8 * k) & 255);
    group = 0;
    digits = padding = 0;
  }
  text.remove_prefix(i);
  return digits == 0;
}

}  // namespace aspic
