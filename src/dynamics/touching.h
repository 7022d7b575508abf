#pragma once
#include <array>
#include <set>
#include <vector>

#include "dynamics/model.h"

namespace aspic {

// Separates surfaces that touch at the start, up to rounding: moves the vertices that touch into their bodies by at
// most the reach, and lets elasticity and contact come to rest. Returns the pairs of parts that touch, in ascending
// order. Leaves q unchanged and returns nothing if surfaces do not touch, or if this does not separate them, because
// they overlap or are pinned. `model` is unchanged on return.
std::set<std::array<int, 2>> separate_touching(Model& model, std::vector<double>& q);

}  // namespace aspic
