// Bodies that are sheets: their mesh and their elasticity.
#pragma once
#include <memory>
#include <optional>
#include <span>

#include "energy/tet_elasticity.h"
#include "scene/body_actions.h"
#include "scene/body_material.h"
#include "scene/body_mesh.h"

namespace aspic {

// Resolves mesh or shape of a body with `shell`, and names its file in the results. Throws InvalidInput.
BodyMesh make_sheet_mesh(Value& body, MeshLoader& loader);

// Returns the elastic energy of a body with `shell`. Adds the rows of angles of mid-edge bending to the model. `held`:
// 1 for each vertex of the model that pins hold. Throws InvalidInput.
std::unique_ptr<TetElasticity> sheet_elasticity(const PlacedBody& body, const BodyMaterial& material,
                                                const std::vector<char>& held, Model& model);

// Adds the drag of `wind`, if the document has one, on all sheets, and a note for a flat sheet in whose plane it blows.
// Throws InvalidInput.
void add_wind(const Table& document, const std::vector<PlacedBody>& bodies, Model& model,
              std::vector<std::string>& notes);

}  // namespace aspic
