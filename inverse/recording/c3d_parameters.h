// Header and parameters of a C3D file [c3d.org, user guide].
#pragma once
#include <bit>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

enum class C3dProcessor { intel = 84, dec = 85, mips = 86 };

// Numbers of a C3D file at byte offsets, in the format of its processor.
class C3dBytes {
 public:
  C3dBytes(std::string file, std::string_view bytes) : file_(std::move(file)), bytes_(bytes) {}

  C3dProcessor processor = C3dProcessor::intel;

  int byte(size_t at) const;  // 0 to 255
  int16_t int16(size_t at) const;
  int uint16(size_t at) const { return static_cast<uint16_t>(int16(at)); }
  double real(size_t at) const;  // IEEE, or VAX F of a DEC processor
  std::string_view text(size_t at, size_t count) const;

  size_t size() const { return bytes_.size(); }
  const std::string& file() const { return file_; }
  [[noreturn]] void fail(size_t at, const std::string& message) const;

 private:
  void require(size_t at, size_t count) const;

  std::string file_;
  std::string_view bytes_;
};

struct C3dParameter {
  int type = 0;              // -1 text, 1 byte, 2 integer, 4 floating point
  std::vector<int> sizes;    // of each dimension; none: a single value
  size_t at = 0, count = 1;  // first byte of the values, and their number
};

class C3dParameters {
 public:
  // Reads the processor, which it stores in `bytes`, and all parameters. Throws InvalidInput.
  explicit C3dParameters(C3dBytes& bytes);

  bool has(const std::string& name) const { return parameters_.contains(name); }  // "POINT:RATE"
  std::optional<double> number(const std::string& name, size_t index = 0) const;
  std::optional<int> unsigned_integer(const std::string& name, size_t index = 0) const;
  std::vector<std::string> texts(const std::string& name) const;  // trimmed; empty if missing

 private:
  size_t read_entry(size_t at);  // returns the offset of the next entry; 0: none
  void read_parameter(const std::string& name, int group, size_t at);

  const C3dBytes& bytes_;
  std::map<int, std::string> groups_;
  std::vector<std::pair<int, std::pair<std::string, C3dParameter>>> unnamed_;  // group, name, parameter
  std::map<std::string, C3dParameter> parameters_;
};

}  // namespace aspic
