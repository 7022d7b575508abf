// Warnings about bodies that can be simulated but are probably not meant so; printed by `run` and `check`.
#pragma once
#include <string>
#include <vector>

#include "scene/body_material.h"

namespace aspic {

// Adds notes about tets that are inverted or flat at the start, and about digits lost far from the origin.
void note_start(const PlacedBody& body, std::vector<std::string>& notes);

// Adds notes about a body crushed by its own weight or stiffer than any material, probably because of a modulus in
// another unit, and about an energy without a minimum. `gravity` in [m/s^2]. has_obstacles: the body may rest on one.
void note_stiffness(const PlacedBody& body, const BodyMaterial& material, const Vec3d& gravity, bool has_obstacles,
                    std::vector<std::string>& notes);

// Adds a note about parts of a body that share no vertex, and parts that no pin fixes. Requires the pins of the model.
void note_parts(const PlacedBody& body, const Model& model, std::vector<std::string>& notes);

}  // namespace aspic
