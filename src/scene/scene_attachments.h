// Attachments of a scene: springs that join the vertices of one body to another, and pins.
#pragma once
#include <string>
#include <vector>

#include "scene/body_actions.h"

namespace aspic {

// Turns attachments to obstacles into pins with the motion of the obstacle. Requires a document whose bodies have
// names. Throws InvalidInput.
void pin_to_obstacles(Table& document);

// Adds the springs of `attach`, if the document has it, to a model that has its bodies and contact. Adds a note for
// each table. Throws InvalidInput.
void add_attachments(Table& document, const std::vector<PlacedBody>& bodies, Model& model,
                     std::vector<std::string>& notes);

}  // namespace aspic
