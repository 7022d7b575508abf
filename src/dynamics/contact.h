// Contact of a model.
#pragma once
#include "contact/barrier.h"
#include "dynamics/model.h"

namespace aspic {

// Adds the barrier to the loads and, if any part has friction, friction to the damping terms. `creep`: see Friction;
// 0: 1e-4 sqrt(9.81 m/s^2 L) for the size L of the model.
void add_contact(ContactMesh mesh, const ContactOptions& options, double creep, Model& model);

}  // namespace aspic
