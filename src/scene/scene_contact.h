// Contact and obstacles of a scene.
#pragma once
#include <array>
#include <set>
#include <string>
#include <vector>

#include "dynamics/model.h"
#include "dynamics/simulation.h"
#include "scene/body_mesh.h"
#include "scene/value.h"

namespace aspic {

// Adds contact to a model that has its bodies, if the document has `contact` or an obstacle. Completes the names of
// obstacles in the document. `q`: initial positions of the model. Throws InvalidInput.
void add_scene_contact(Table& document, MeshLoader& loader, const std::vector<double>& q, Model& model);

// Returns the energy of contact at the start with the pair and the remedy, if it is large enough to move bodies; else
// an empty string.
std::string start_warning(const Simulation& simulation);

// Adds a note that names pairs of parts which touched at the start and were separated.
void note_touching(const std::set<std::array<int, 2>>& pairs, const Model& model, MeshLoader& loader);

}  // namespace aspic
