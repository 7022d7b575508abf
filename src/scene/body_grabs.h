// Grabs of a scene: springs from points of tets to ends that move along paths.
#pragma once
#include <vector>

#include "scene/body_actions.h"

namespace aspic {

// Adds one load for the [[body.grab]] of all bodies, if there are any. Throws InvalidInput.
void add_grabs(const std::vector<PlacedBody>& bodies, Model& model);

}  // namespace aspic
