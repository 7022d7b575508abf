// [solver] of a checked scene.
#pragma once
#include "optimize/solver.h"
#include "scene/value.h"

namespace aspic {

// Throws InvalidInput, with the place, for a choice that the chosen methods have no use for.
SolverOptions solver_options(const Value& solver);

}  // namespace aspic
