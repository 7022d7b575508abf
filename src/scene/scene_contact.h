// Contact and obstacles of a scene.
#pragma once
#include "dynamics/model.h"
#include "scene/body_mesh.h"
#include "scene/value.h"

namespace aspic {

// Adds contact to a model that has its bodies, if the document has `contact` or an obstacle. Completes the names of
// obstacles in the document. Throws InvalidInput.
void add_scene_contact(Table& document, MeshLoader& loader, Model& model);

}  // namespace aspic
