// What is worth a second look in a body though it can be simulated: said before the first step, by `run` and `check`.
#pragma once
#include <string>
#include <vector>

#include "scene/body_material.h"

namespace aspic {

// Tets that start inverted or flat; digits lost far from the origin.
void note_start(const PlacedBody& body, std::vector<std::string>& notes);

// A body that its own weight crushes, or one stiffer than any material: both tell of a modulus in another unit. An
// energy that has no least value. `gravity` in [m/s^2].
void note_stiffness(const PlacedBody& body, const BodyMaterial& material, const Vec3d& gravity,
                    std::vector<std::string>& notes);

// Parts of a body that share no vertex, and those among them that are free though pins hold the others. The model has
// its pins.
void note_parts(const PlacedBody& body, const Model& model, std::vector<std::string>& notes);

}  // namespace aspic
