// Checked access to the JSON and the numbers of a glTF 2.0 file [Khronos].
#pragma once
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf_reader.h"

namespace aspic {

// All functions throw InvalidInput "file: byte N: problem; remedy".
class GltfFile {
 public:
  using Json = nlohmann::json;

  // The contents must outlive the file.
  GltfFile(const std::string& file, std::string_view contents, const ReadBeside& read_beside);

  [[noreturn]] void fail(const std::string& message,
                         const char* remedy = "export it again, or get a complete copy") const;

  static std::string name(const char* what, uint64_t index) {
    return std::string(what) + "[" + std::to_string(index) + "]";
  }
  static const Json* member(const Json& object, const char* key);  // nullptr: none
  const Json& list(const Json& object, const char* key) const;     // empty: none
  const Json& list(const char* key) const { return list(root_, key); }
  const Json& item(const char* key, uint64_t index) const;  // of a list of the file
  const Json& scene() const;                                // the default one
  uint64_t integer(const Json& object, const char* key, const std::string& owner,
                   std::optional<uint64_t> fallback = std::nullopt) const;
  template <size_t n>
  std::array<double, n> numbers(const Json& node, const char* key, std::array<double, n> fallback) const {
    const Json& given = list(node, key);
    if (given.empty()) return fallback;
    if (given.size() != n) fail(std::string(key) + " of a node has " + std::to_string(given.size()) + " numbers");
    for (size_t i = 0; i < n; ++i) {
      if (!given[i].is_number() || !std::isfinite(given[i].get<double>()))
        fail(std::string(key) + " of a node has no number");
      fallback[i] = given[i].get<double>();
    }
    return fallback;
  }

  std::string self_contained() const;  // the file as JSON with all buffers inside

  // Returns the numbers of an accessor, which are finite. `shape`: SCALAR, VEC2, VEC3, VEC4 or MAT4.
  std::vector<double> reals(uint64_t accessor, const char* shape) { return values(accessor, shape, false); }
  std::vector<double> indices(uint64_t accessor, const char* shape) { return values(accessor, shape, true); }

 private:
  struct View {
    std::string_view bytes;
    uint64_t stride;  // 0: the elements follow each other
  };

  void open(std::string_view contents);
  void check_head() const;
  void read_buffers(const ReadBeside& read_beside);
  std::string bytes_of(std::string_view uri, const std::string& owner, const ReadBeside& read_beside) const;
  View view(uint64_t index) const;
  std::vector<double> values(uint64_t accessor, const char* shape, bool are_indices);

  std::string file_;
  Json root_;
  size_t json_at_ = 0;
  std::string_view binary_;
  std::vector<std::string> buffers_;
  uint64_t budget_ = uint64_t{1} << 22;  // elements that accessors may still give; many nodes may repeat a mesh
};

}  // namespace aspic
