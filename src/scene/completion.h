// What the schema cannot say key by key: names, and parameters that depend on the material.
#pragma once
#include "scene/value.h"

namespace aspic {

// Names bodies and pins, fills in the extra parameters of materials, and checks what relates several keys. The
// document has passed check_and_complete(). Throws InvalidInput.
void complete_scene(Table& document);

}  // namespace aspic
