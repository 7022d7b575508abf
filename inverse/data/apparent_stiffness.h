// Estimates of the stiffness from indentations, without simulation.
#pragma once
#include <optional>

#include "model/misfit.h"

namespace aspic {

// Young's modulus of a half-space with the same force and depth: F (1 - nu^2) = 2 a d E for a flat punch of radius a,
// nu = 0.4. Empty without indenter, force or depth. [Johnson 1985, section 3.4]
std::optional<double> apparent_young(const LoadCase& load);
// Median over all cases; empty without cases.
std::optional<double> apparent_young(const Measured& experiment);

}  // namespace aspic
