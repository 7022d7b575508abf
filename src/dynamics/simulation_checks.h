// Checks of a model and its options before a simulation starts. Each throws InvalidInput.
#pragma once
#include <span>

#include "base/error.h"
#include "dynamics/integrator.h"
#include "dynamics/simulation.h"

namespace aspic {

// Thrown if tets are inverted in the initial state and their material does not allow it.
class InvertedStart : public InvalidInput {
 public:
  explicit InvertedStart(const std::string& cause)
      : InvalidInput(cause +
                     "; choose the material stable_neo_hookean, which tolerates inversion, or choose a smaller "
                     "initial deformation"),
        cause_(cause) {}
  const std::string& cause() const { return cause_; }  // without the remedy

 private:
  std::string cause_;
};

void require_mass(const Model& model, const Pins& pins);                    // requires mass at every free vertex
void require_finite_energy(const Model& model, std::span<const double> x);  // requires a finite initial energy
// Requires that no surfaces of a contact intersect or touch, and that the integrator can keep them apart.
void require_apart(const Model& model, const State& start, const IntegratorFacts& integrator);
void require_possible(const SimulationOptions& options);

}  // namespace aspic
