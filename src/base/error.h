// Bad input: thrown at the edges only (files, scenes, command line), never by the numerical core.
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

// The message names the place (file:line:column where there is one), the value and the remedy, in one line:
//   beam.toml:12:3: poisson = 0.5; neo_hookean needs -1 < poisson < 0.5 (try 0.49)
class InvalidInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The entry of `known` closest to `word` by edit distance; empty when none is close enough to be meant.
std::string nearest_name(std::string_view word, const std::vector<std::string>& known);

// " (did you mean 'young'?)" or, when nothing is near, " (known: a, b, c)".
std::string suggestion(std::string_view word, const std::vector<std::string>& known);

}  // namespace aspic
