#pragma once
#include <vector>

#include "dynamics/model.h"

namespace aspic {

// Moves bodies that overlap at the start apart: shrinks those without pins about their centers until no surfaces
// intersect, and lets their elasticity grow them back in contact. Positions that do not overlap stay as they are.
// `model` is unchanged afterwards. Throws InvalidInput if bodies do not come apart or do not regain their volume.
void inflate(Model& model, std::vector<double>& q);

}  // namespace aspic
