// Assigned states of simulations, and pickles of snapshots.
#pragma once
#include "simulation.h"

namespace aspic::python {

// Fixed pins hold their vertices where `q` has them. Throws InvalidInput if it contradicts a moving pin.
void set_positions(LiveSimulation& simulation, const py::object& q);
// Throws InvalidInput if `v` contradicts a pin. 0 is accepted, because velocities of pinned vertices have no effect.
void set_velocities(LiveSimulation& simulation, const py::object& v);

void bind_snapshot(py::module_& m);

}  // namespace aspic::python
