// Defaults that depend on the data set; each choice is a note.
#pragma once
#include "data/data_set.h"

namespace aspic {

// Radius of an indenter, relative to the size of the body: wider than a tet of the example scenes. Chosen.
inline constexpr double kUsualRadius = 0.08;

// Replaces standard deviations of 0 by a fraction of the largest motion, force and torque.
void choose_sigmas(DataSet& data);

// Stiffness of the contact layer, far above that of a body with the given Young's modulus [Pa/m].
double layer_stiffness(const Indenter& indenter, double young);

// Replaces layer stiffnesses of 0 by values far above that of the body [Pa/m].
void choose_layers(DataSet& data);

}  // namespace aspic
