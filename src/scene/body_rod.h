// Bodies that are rods: their mesh, their elasticity and their prescribed twist.
#pragma once
#include <memory>
#include <vector>

#include "energy/rod.h"
#include "energy/tet_elasticity.h"
#include "scene/body_actions.h"
#include "scene/body_material.h"
#include "scene/body_mesh.h"

namespace aspic {

// Resolves mesh or shape of a body with `rod`, and names its file in the results. Throws InvalidInput.
BodyMesh make_rod_mesh(Value& body, MeshLoader& loader);

// Returns the stretching energy of a body with `rod`. Adds its rows of angles and the pins of its twist to the model,
// and its segments to those of all rods. `held`: 1 for each vertex of the model that pins hold. Throws InvalidInput.
std::unique_ptr<TetElasticity> rod_elasticity(const PlacedBody& body, const BodyMaterial& material,
                                              const std::vector<char>& held, Model& model,
                                              std::vector<RodSegment>& segments);

}  // namespace aspic
