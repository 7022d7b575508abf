// What the tets of a body are made of: by numbers, formulas and fields of the scene, or by a fitted material's file.
#pragma once
#include <string>
#include <vector>

#include "material/registry.h"
#include "scene/body_actions.h"
#include "scene/scene_files.h"

namespace aspic {

struct BodyMaterial {
  std::string model;
  std::vector<MaterialParameters> parameters;  // one per tet, in the user's order
  std::vector<double> density;                 // likewise [kg/m^3]
};

// Leaves in the body's table what gives the same material again. Throws InvalidInput.
BodyMaterial body_material(PlacedBody& body, SceneFiles& files, std::vector<std::string>& notes);

}  // namespace aspic
