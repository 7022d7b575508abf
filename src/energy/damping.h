// Dissipative terms D(x; start): incremental potentials of a step from `start`, with the derivatives that the gradient
// of a trajectory needs.
#pragma once
#include <span>

#include "energy/energy.h"

namespace aspic {

class TetElasticity;

// Where the derivatives of w . dD/dx are added. Empty spans are skipped.
struct DampingGradients {
  std::span<double> start;         // with respect to the start of the step, 3 per vertex
  std::span<double> coefficients;  // to those of the term, coefficient_count() of them
  std::span<double> elastic;       // to theta of elasticity(), as in TetElasticity::add_parameter_gradient
};

class Damping : public Energy {
 public:
  virtual int coefficient_count() const = 0;
  virtual const TetElasticity* elasticity() const { return nullptr; }  // whose parameters D depends on
  virtual double mass_factor(int /*vertex*/) const { return 0; }  // a of a part a/(2h) |x - start|_M^2 around a vertex
  // For a step that starts where coefficients are taken.
  virtual void add_derivatives(Positions x, const Context& context, std::span<const double> w, double scale,
                               const DampingGradients& gradients) const = 0;
};

}  // namespace aspic
