// Contact of a model.
#pragma once
#include "contact/barrier.h"
#include "dynamics/model.h"

namespace aspic {

// Returns 1e-4 sqrt(g L) [m/s] for an acceleration of gravity g [m/s^2] and the size L [m] of the model.
double default_creep(double gravity, const Model& model);

// Adds the barrier to the loads and, if any pair has friction, friction to the damping terms. `creep`: see Friction; 0:
// the default for 9.81 m/s^2.
void add_contact(ContactMesh mesh, const ContactOptions& options, double creep, Model& model);

}  // namespace aspic
