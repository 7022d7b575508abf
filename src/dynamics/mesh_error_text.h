// The estimate of mesh_error.h in words.
#pragma once
#include <string>

#include "dynamics/simulation.h"

namespace aspic {

// Returns one sentence per body, the remedy for the worst one, and what the estimate leaves out; or why there is none.
// For example: "makes 'bar' about 18 % too stiff (displacements err by 15 %). `order = 2`, or edges
// of 0.0066 m instead of 0.02 m, would reach about 2 % where the solution is smooth. An estimate."
std::string mesh_error_text(const MeshErrorEstimate& error, const Simulation& simulation);

// Computes the estimate at the state after a step, and writes it into the step's report.
void add_mesh_error(const Simulation& simulation, const StopToken& stop, StepReport& report);

}  // namespace aspic
