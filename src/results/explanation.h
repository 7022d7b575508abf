// Explains why a step did not converge: cause, place, and the most promising remedy.
#pragma once
#include <string>

#include "dynamics/simulation.h"

namespace aspic {

struct Explanation {
  std::string cause;   // "the line search found no step along Newton's direction that lowers the energy"
  std::string place;   // the vertex, tet or parameter at fault; empty: the whole body
  std::string remedy;  // one suggestion
};

// Explains the last step of the simulation. The explanation of a converged step is empty.
Explanation explain(const Simulation& simulation, const StepReport& report);

}  // namespace aspic
