// What a poke says of the stiffness without any simulation.
#pragma once
#include <optional>

#include "fit/misfit.h"

namespace aspic {

// Young's modulus of a half-space that would push back as a case says: F (1 - nu^2) = 2 a d E for a flat punch of
// radius a, nu = 0.4. None: no tip, no force, no way. [Johnson 1985, section 3.4]
std::optional<double> apparent_young(const LoadCase& load);
// The median of all cases; none: there are none.
std::optional<double> apparent_young(const Experiment& experiment);

double median(std::vector<double> values);  // of at least one

}  // namespace aspic
