// What every run of every scene owes: a status that is true, numbers that are numbers, energies that add up, and words
// where something failed.
#pragma once
#include <string>

#include "scene/scene.h"

namespace aspic {

struct Judgment {
  std::string ending;  // "converged", "refused", or the status of the first step that failed
  std::string detail;  // the words of the refusal or the explanation
  std::string fault;   // what the run owes and does not give; empty: nothing
};

// Runs the scene of that text to its end, whatever its steps end with.
Judgment judge(Scene& scene, const std::string& text);

}  // namespace aspic
