// Validated access to the members of a JSON object from an untrusted source.
#pragma once
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "math/small.h"

namespace aspic::viewer {

using Json = nlohmann::json;

// Throws InvalidInput for text that is not JSON, is nested too deeply, or is longer than `most` bytes.
Json parse_json(std::string_view text, size_t most);

// Throws InvalidInput: "KEY = VALUE: " and the description of valid values.
[[noreturn]] void refuse(const std::string& key, const Json& value, const std::string& expected);

class Arguments {
 public:
  // `name`: the command, for messages. `object` must outlive this. Throws InvalidInput if it is not a JSON object.
  Arguments(const Json& object, std::string name);

  bool has(const char* key) const { return object_.contains(key); }
  const Json& value(const char* key);                     // any type; this and all below throw InvalidInput
  double number(const char* key);                         // a finite number
  int integer(const char* key, int lowest, int highest);  // within both bounds, inclusive
  bool boolean(const char* key);
  std::string text(const char* key, size_t most = 4096);                         // at most `most` bytes
  std::string choice(const char* key, const std::vector<std::string>& choices);  // one of at least two
  Vec3d vector(const char* key);                                                 // three finite numbers
  Vec3d weights(const char* key);                        // barycentric coordinates, from 0 to 1 with sum 1
  std::vector<std::string> texts(const char* key);       // at most 200 strings of at most 4096 bytes
  std::vector<int> indices(const char* key, int count);  // integers from 0 to count - 1
  void finish() const;                                   // throws InvalidInput for members that were not read

 private:
  [[noreturn]] void fail(const char* key, const std::string& expected) const;

  const Json& object_;
  std::string name_;
  std::set<std::string> known_;
};

}  // namespace aspic::viewer
