// Where the minimisation of a step starts.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

enum class InitialGuess {
  none,            // nothing is minimised: explicit schemes
  best,            // the lowest energy of those below, but for zero
  zero,            // no displacement: the shape at rest
  current,         // q
  extrapolated,    // q + h qdot, the flight without forces
  last_increment,  // q + what the previous step added
  accelerated,     // q~ + beta^2 (mean acceleration in the previous step): the stage with its forces
};
std::string_view to_string(InitialGuess guess);

std::vector<std::string> initial_guess_names();             // those to choose from
InitialGuess initial_guess_named(const std::string& name);  // throws InvalidInput for an unknown name

}  // namespace aspic
