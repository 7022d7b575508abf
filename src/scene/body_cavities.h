// Cavities of a scene: gas or liquid in inner surfaces of bodies.
#pragma once
#include <string>
#include <vector>

#include "scene/body_actions.h"

namespace aspic {

// Adds a load for each [[body.cavity]]: cavity, cavity_2, ... up: against gravity, of length 1. Throws InvalidInput.
void add_cavities(std::vector<PlacedBody>& bodies, const Vec3d& up, std::vector<std::string>& notes, Model& model);

}  // namespace aspic
