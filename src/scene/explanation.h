// Why a step did not converge, in words: what happened, where, and the one change that is most likely to help.
#pragma once
#include <string>

#include "dynamics/simulation.h"

namespace aspic {

struct Explanation {
  std::string cause;   // "the line search found no step along Newton's direction that lowers the energy"
  std::string place;   // the vertex, tet or parameter at fault; empty when the whole body is
  std::string remedy;  // one suggestion
};

// Of the step that the simulation took last. A step that converged has an empty explanation.
Explanation explain(const Simulation& simulation, const StepReport& report);

}  // namespace aspic
