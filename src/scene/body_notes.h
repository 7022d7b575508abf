// Warnings about bodies that can be simulated but are probably not meant so; printed by `run` and `check`.
#pragma once
#include <string>
#include <vector>

#include "scene/body_material.h"

namespace aspic {

// Tets that start inverted or flat; digits lost far from the origin.
void note_start(const PlacedBody& body, std::vector<std::string>& notes);

// A body crushed by its own weight or stiffer than any material, probably with a modulus in another unit; an energy
// without a minimum. `gravity` in [m/s^2].
void note_stiffness(const PlacedBody& body, const BodyMaterial& material, const Vec3d& gravity,
                    std::vector<std::string>& notes);

// Parts of a body that share no vertex, and those that no pin holds. Requires the pins of the model.
void note_parts(const PlacedBody& body, const Model& model, std::vector<std::string>& notes);

}  // namespace aspic
