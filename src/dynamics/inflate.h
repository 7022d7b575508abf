#pragma once
#include <vector>

#include "dynamics/model.h"

namespace aspic {

// Separates bodies that overlap at the start: shrinks those without pins about their centers until no surfaces
// intersect, and lets their elasticity grow them back in contact. Positions that do not overlap are unchanged. `model`
// is unchanged on return. Throws InvalidInput if bodies cannot be separated or do not regain their volume.
void inflate(Model& model, std::vector<double>& q);

}  // namespace aspic
