// Bad input: thrown at the edges only (files, scenes, command line), never by the numerical core.
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

// The message names the place (file:line:column where there is one), the value and the remedy, in one line:
//   beam.toml:12:3: poisson = 0.5; neo_hookean needs -1 < poisson < 0.5 (try 0.49)
// Messages quote files, so what a terminal would obey or JSON could not hold is shown as \xNN (printable.h), and a line
// has at most kLongestMessage bytes: where it has more, its middle is left out.
class InvalidInput : public std::runtime_error {
 public:
  static constexpr size_t kLongestMessage = 4000;

  explicit InvalidInput(std::string_view message);
  explicit InvalidInput(const std::vector<std::string>& messages);  // one per line
};

// The entry of `known` closest to `word` by edit distance; empty when none is close enough to be meant.
std::string nearest_name(std::string_view word, const std::vector<std::string>& known);

// " (did you mean 'young'?)" or, when nothing is near, " (known: a, b, c)".
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

}  // namespace aspic
