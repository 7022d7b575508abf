// Reads [solver] of a checked scene.
#pragma once
#include "optimize/solver.h"
#include "scene/value.h"

namespace aspic {

// Throws InvalidInput with the place of an option that the chosen methods do not use.
SolverOptions solver_options(const Value& solver);

}  // namespace aspic
