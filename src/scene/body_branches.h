// Viscoelastic branches of a scene.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/body_actions.h"

namespace aspic {

struct BranchScope {
  SceneFiles& files;
  std::int64_t memory;  // maximum memory [bytes]
};

// Adds a damping term for each body with [[body.viscoelastic]]: viscoelastic, viscoelastic_2, ... Requires the elastic
// terms of the model. Throws InvalidInput.
void add_branches(std::vector<PlacedBody>& bodies, const BranchScope& scope, Model& model);

}  // namespace aspic
