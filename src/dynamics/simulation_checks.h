// What is asked of a model and of options before a simulation begins. Each throws InvalidInput.
#pragma once
#include <span>

#include "dynamics/integrator.h"
#include "dynamics/simulation.h"

namespace aspic {

void require_mass(const Model& model, const Pins& pins);                    // in every free vertex
void require_finite_energy(const Model& model, std::span<const double> x);  // nothing inside out at the start
void require_possible(const SimulationOptions& options, const Integrator& integrator, InitialGuess guess);

}  // namespace aspic
