// What is asked of a model and of options before a simulation begins. Each throws InvalidInput.
#pragma once
#include <span>

#include "base/error.h"
#include "dynamics/integrator.h"
#include "dynamics/simulation.h"

namespace aspic {

// Tets are inverted at the start, where their material has no energy.
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

void require_mass(const Model& model, const Pins& pins);                    // in every free vertex
void require_finite_energy(const Model& model, std::span<const double> x);  // nothing inside out at the start
void require_possible(const SimulationOptions& options);

}  // namespace aspic
