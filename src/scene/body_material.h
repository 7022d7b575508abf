// The material of each tet of a body: from numbers, formulas and fields of the scene, or from the file of a fitted
// material.
#pragma once
#include <string>
#include <vector>

#include "material/registry.h"
#include "scene/body_actions.h"
#include "scene/scene_files.h"

namespace aspic {

struct BodyMaterial {
  std::string model;
  std::vector<MaterialParameters> parameters;  // one per tet, in the order of the mesh file
  std::vector<double> density;                 // one per tet [kg/m^3]
};

// Rewrites the material in the body's table so that the resolved scene gives the same one. Throws InvalidInput.
BodyMaterial body_material(PlacedBody& body, SceneFiles& files, std::vector<std::string>& notes);

}  // namespace aspic
