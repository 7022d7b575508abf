// The members of a JSON object that came from outside, one by one: of the right type and size, or refused in words.
#pragma once
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "math/small.h"

namespace aspic::viewer {

using Json = nlohmann::json;

// Throws InvalidInput for text that is no JSON, nests deeper than any message does, or is longer than `most` bytes.
Json parse_json(std::string_view text, size_t most);

// What would do, after "KEY = VALUE: "; throws InvalidInput.
[[noreturn]] void refuse(const std::string& key, const Json& value, const std::string& what_would_do);

class Arguments {
 public:
  // `name` of the command, for messages. Throws InvalidInput unless it is an object. `object` must outlive this.
  Arguments(const Json& object, std::string name);

  bool has(const char* key) const { return object_.contains(key); }
  const Json& value(const char* key);                     // any; each of these throws InvalidInput
  double number(const char* key);                         // finite
  int integer(const char* key, int lowest, int highest);  // both included
  bool boolean(const char* key);
  std::string text(const char* key, size_t most = 4096);  // bytes
  Vec3d vector(const char* key);                          // three finite numbers
  Vec3d weights(const char* key);                         // of a triangle's corners: from 0 to 1, their sum is 1
  std::vector<std::string> texts(const char* key);        // at most 200 of at most 4096 bytes
  std::vector<int> indices(const char* key, int count);   // each below count
  void finish() const;                                    // refuses members that nobody asked for

 private:
  [[noreturn]] void fail(const char* key, const std::string& what_would_do) const;

  const Json& object_;
  std::string name_;
  std::set<std::string> known_;
};

}  // namespace aspic::viewer
