// Requirements on every run of every scene: a correct status, finite numbers, balanced energies, and a message for each
// failure.
#pragma once
#include <string>

#include "scene/scene.h"

namespace aspic {

struct Judgment {
  std::string ending;  // "converged", "refused", or the status of the first step that failed
  std::string detail;  // message of the refusal or explanation of the failure
  std::string fault;   // violated requirement; empty: none
};

// Runs the scene to its end, whatever the status of its steps.
Judgment judge(Scene& scene, const std::string& text);

}  // namespace aspic
