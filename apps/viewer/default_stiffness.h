// Default stiffness of the mouse spring.
#pragma once
#include <optional>

#include "dynamics/model.h"

namespace aspic::viewer {

// Returns the geometric mean of Young's modulus over the volume, which limits the influence of a stiff core; empty
// without elasticity [Pa].
std::optional<double> mean_young(const Model& model);

// E times the edge length of a tet [N/m]. A stiffer spring would invert the tets at the mouse.
double default_stiffness(const Model& model);

}  // namespace aspic::viewer
