// The initial guess of a step's minimization.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

enum class InitialGuess {
  none,            // explicit schemes: nothing is minimized
  best,            // the one with the lowest energy of those below, except zero
  zero,            // no displacement: the shape at rest
  current,         // q
  extrapolated,    // q + h qdot, motion without forces
  last_increment,  // q + increment of the previous step
  accelerated,     // q~ + beta^2 (mean acceleration in the previous step): the stage with its forces
};
std::string_view to_string(InitialGuess guess);

std::vector<std::string> initial_guess_names();             // the names that options accept
InitialGuess initial_guess_named(const std::string& name);  // throws InvalidInput for an unknown name

}  // namespace aspic
