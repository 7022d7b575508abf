// Initial guesses of a minimization.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

enum class InitialGuess {
  none,            // explicit schemes: no minimization
  best,            // the guess of lowest energy among those below, except zero
  zero,            // the rest shape
  current,         // q
  extrapolated,    // q + h qdot: motion without forces
  last_increment,  // q + increment of the previous step
  accelerated,     // q~ + beta^2 (mean acceleration of the previous step): the stage with its forces
};
std::string_view to_string(InitialGuess guess);

std::vector<std::string> initial_guess_names();             // names that options accept
InitialGuess initial_guess_named(const std::string& name);  // throws InvalidInput for an unknown name

}  // namespace aspic
