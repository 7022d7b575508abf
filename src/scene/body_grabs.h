// Hands of a scene: springs between points of tets and ends that move along paths.
#pragma once
#include <vector>

#include "scene/body_actions.h"

namespace aspic {

// Adds one load for the [[body.grab]] of all bodies, if there are any. Throws InvalidInput.
void add_grabs(const std::vector<PlacedBody>& bodies, Model& model);

}  // namespace aspic
