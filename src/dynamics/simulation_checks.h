// Checks of a model and its options before a simulation. Each throws InvalidInput.
#pragma once
#include <span>

#include "base/error.h"
#include "dynamics/integrator.h"
#include "dynamics/simulation.h"

namespace aspic {

// An initial state whose remedy user interfaces can describe by the names of their own options.
struct BadInitialState : InvalidInput {
  enum class Kind { inverted_tets, collapsed_triangles, no_mass, touches_itself };

  BadInitialState(Kind k, const std::string& why, const std::string& remedy)
      : InvalidInput(why + "; " + remedy), kind(k), cause(why) {}
  Kind kind;
  std::string cause;  // without the remedy
};

void require_mass(const Model& model, const Pins& pins);                    // requires mass at every free vertex
void require_finite_energy(const Model& model, std::span<const double> x);  // requires a finite initial energy
// Requires that no surfaces in contact intersect or touch, and that the integrator can keep them apart.
void require_apart(const Model& model, const State& start, const IntegratorFacts& integrator);
void require_possible(const SimulationOptions& options);

}  // namespace aspic
