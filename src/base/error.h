// The exception for invalid input: values, files, scenes. Numerical failures are a Status in a report instead.
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

// A message is one line with the location (file:line:column if available), the value and the remedy:
//   beam.toml:12:3: poisson = 0.5; neo_hookean needs -1 < poisson < 0.5 (try 0.49)
// Control characters are printed as \xNN. Lines longer than kLongestMessage bytes are shortened in the middle.
class InvalidInput : public std::runtime_error {
 public:
  static constexpr size_t kLongestMessage = 4000;

  explicit InvalidInput(std::string_view message);
  explicit InvalidInput(const std::vector<std::string>& messages);  // one per line
};

// Returns the synonym of `word` in `known`, or the entry closest by edit distance; empty if none is close.
std::string nearest_name(std::string_view word, const std::vector<std::string>& known);

// Returns " (did you mean 'young'?)" or, if no known name is close, " (known: a, b, c)".
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

}  // namespace aspic
