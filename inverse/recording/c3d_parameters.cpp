#include "recording/c3d_parameters.h"

#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/printable.h"

namespace aspic {
namespace {

constexpr size_t kBlock = 512;
constexpr int kKey = 80;  // second byte of every C3D file

std::string upper(std::string_view text) {
  std::string result;
  for (const char c : text) result += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

// VAX F: sign, exponent with the bias 128, and the fraction of a mantissa in [1/2, 1); there is no infinity.
double vax_f(uint32_t bits) {
  const int exponent = static_cast<int>(bits >> 23 & 0xff);
  if (exponent == 0) return 0;
  const double mantissa = 1 + static_cast<double>(bits & 0x7fffff) / 8388608.0;
  return std::ldexp(bits >> 31 ? -mantissa : mantissa, exponent - 129);
}

}  // namespace

void C3dBytes::fail(size_t at, const std::string& message) const {
  throw InvalidInput(file_ + ": byte " + std::to_string(at) + ": " + message);
}

void C3dBytes::require(size_t at, size_t count) const {
  if (at > bytes_.size() || count > bytes_.size() - at)
    fail(bytes_.size(), "the file ends before byte " + std::to_string(at) + "; it is cut short, get a complete copy");
}

int C3dBytes::byte(size_t at) const {
  require(at, 1);
  return static_cast<unsigned char>(bytes_[at]);
}

int16_t C3dBytes::int16(size_t at) const {
  const int first = byte(at), second = byte(at + 1);
  return static_cast<int16_t>(processor == C3dProcessor::mips ? first << 8 | second : second << 8 | first);
}

double C3dBytes::real(size_t at) const {
  const auto low = static_cast<uint32_t>(uint16(at)), high = static_cast<uint32_t>(uint16(at + 2));
  if (processor == C3dProcessor::dec) return vax_f(low << 16 | high);
  const uint32_t bits = processor == C3dProcessor::mips ? low << 16 | high : high << 16 | low;
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::string_view C3dBytes::text(size_t at, size_t count) const {
  require(at, count);
  return bytes_.substr(at, count);
}

C3dParameters::C3dParameters(C3dBytes& bytes) : bytes_(bytes) {
  if (bytes.byte(1) != kKey)
    bytes.fail(1, "is " + std::to_string(bytes.byte(1)) + "; a C3D file has 80 there. Is this a C3D file?");
  if (bytes.byte(0) < 2)
    bytes.fail(0, "the parameters begin in block " + std::to_string(bytes.byte(0)) + "; block 1 is the header");
  const size_t start = (static_cast<size_t>(bytes.byte(0)) - 1) * kBlock;
  const int processor = bytes.byte(start + 3);
  if (processor < 84 || processor > 86)
    bytes.fail(start + 3, "the processor is " + std::to_string(processor) +
                              "; known are 84 (Intel), 85 (DEC) and 86 (MIPS). Export the file again");
  bytes.processor = static_cast<C3dProcessor>(processor);
  for (size_t at = start + 4; at != 0 && at + 2 <= bytes.size();) at = read_entry(at);
  for (auto& [group, named] : unnamed_) parameters_.try_emplace(groups_[group] + ":" + named.first, named.second);
}

// A group or a parameter: length of the name (negative: locked), group (negative for a group), name, offset to the
// next.
size_t C3dParameters::read_entry(size_t at) {
  const size_t length = static_cast<size_t>(std::abs(static_cast<int8_t>(bytes_.byte(at))));
  const int group = static_cast<int8_t>(bytes_.byte(at + 1));
  if (length == 0 || group == 0) return 0;
  const std::string name = upper(bytes_.text(at + 2, length));
  const size_t link = at + 2 + length;
  const int offset = bytes_.uint16(link);
  if (group < 0) {
    groups_[-group] = name;
  } else {
    read_parameter(name, group, link + 2);
  }
  if (offset == 0) return 0;
  if (offset < 2)
    bytes_.fail(link, "the next parameter overlaps this one, '" + printable(name) + "'; the file is damaged");
  return link + static_cast<size_t>(offset);
}

void C3dParameters::read_parameter(const std::string& name, int group, size_t at) {
  C3dParameter parameter{static_cast<int8_t>(bytes_.byte(at)), {}, 0, 1};
  const int dimensions = bytes_.byte(at + 1);
  const size_t width = static_cast<size_t>(std::abs(parameter.type));
  if (width != 1 && width != 2 && width != 4)
    bytes_.fail(at, "the type of '" + printable(name) + "' is " + std::to_string(parameter.type) +
                        "; known are -1, 1, 2 and 4. The file is damaged");
  for (int d = 0; d < dimensions; ++d) {
    parameter.sizes.push_back(bytes_.byte(at + 2 + d));
    parameter.count *= static_cast<size_t>(parameter.sizes.back());
    if (parameter.count > bytes_.size())
      bytes_.fail(at + 2 + d, "'" + printable(name) + "' has more values than the file has bytes; it is damaged");
  }
  parameter.at = at + 2 + static_cast<size_t>(dimensions);
  bytes_.text(parameter.at, parameter.count * width);
  unnamed_.push_back({group, {name, parameter}});
}

std::optional<double> C3dParameters::number(const std::string& name, size_t index) const {
  const auto found = parameters_.find(name);
  if (found == parameters_.end() || index >= found->second.count) return std::nullopt;
  const C3dParameter& p = found->second;
  if (p.type == 4) return bytes_.real(p.at + 4 * index);
  if (p.type == 2) return bytes_.int16(p.at + 2 * index);
  if (p.type == 1) return bytes_.byte(p.at + index);
  return std::nullopt;
}

std::optional<int> C3dParameters::unsigned_integer(const std::string& name, size_t index) const {
  const std::optional<double> value = number(name, index);
  if (!value || !std::isfinite(*value) || std::abs(*value) > 1e9) return std::nullopt;
  const int whole = static_cast<int>(*value);
  return whole < 0 ? whole + 65536 : whole;
}

std::vector<std::string> C3dParameters::texts(const std::string& name) const {
  std::vector<std::string> result;
  const auto found = parameters_.find(name);
  if (found == parameters_.end() || found->second.type != -1) return result;
  const C3dParameter& p = found->second;
  const size_t length = p.sizes.empty() ? 1 : static_cast<size_t>(p.sizes[0]);
  for (size_t at = 0; length > 0 && at + length <= p.count; at += length) {
    std::string text(bytes_.text(p.at + at, length));
    text.erase(text.find_last_not_of(std::string_view(" \0", 2)) + 1);
    text.erase(0, text.find_first_not_of(' '));
    result.push_back(printable(text));
  }
  return result;
}

}  // namespace aspic
