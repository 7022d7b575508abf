// What a data set leaves open, chosen from what it says; each choice is a note.
#pragma once
#include "capture/data_set.h"

namespace aspic {

// Standard deviations that are 0: a share of the largest motion, force and torque.
void choose_deviations(DataSet& data);

// Of the layer of a tip on a body of a Young's modulus [Pa], far above that [Pa/m].
double layer_stiffness(const Tip& tip, double young);

// The stiffness of the layers of tips where it is 0, far above that of the body [Pa/m].
void choose_layers(DataSet& data);

}  // namespace aspic
