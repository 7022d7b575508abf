// Checks and defaults that involve several keys: names, parameters that depend on the material.
#pragma once
#include "scene/value.h"

namespace aspic {

// Names bodies and pins, fills in the extra parameters of materials, and checks conditions between keys. Requires a
// document that passed check_and_complete(). Throws InvalidInput.
void complete_scene(Table& document);

}  // namespace aspic
