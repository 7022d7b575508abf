// Refines the simulated mesh where stresses vary fastest: below indenters, and along the rims of held surfaces. The
// parameters stay on the mesh of the data (Experiment::parent).
#pragma once
#include "model/misfit.h"

namespace aspic {

inline constexpr int kMostGrowth = 3;  // limit of the number of tets, relative to the mesh of the data. Chosen

// Bisects longest edges [Rivara 1984] until the edges within the radius of an indenter are at most half of it and the
// tets at rims have half their size, and then where neighbors would not match. Without indenters and grips, and with
// pressures, the mesh stays as it is.
Experiment locally_refined(const Experiment& experiment);

}  // namespace aspic
