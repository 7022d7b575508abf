// Families of fibres of a scene.
#pragma once
#include <vector>

#include "scene/body_actions.h"

namespace aspic {

struct FibreScope {
  Vec3d up;  // against gravity, of length 1
  SceneFiles& files;
};

// Adds a load for each [[body.fibre]] and [[body.muscle]]: fibre, fibre_2, ..., muscle, ... Throws InvalidInput.
void add_fibres(std::vector<PlacedBody>& bodies, const FibreScope& scope, Model& model);

}  // namespace aspic
