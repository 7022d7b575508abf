// Dissipative terms D(x; start): incremental potentials of a time step from `start`, with the derivatives for
// trajectory gradients.
#pragma once
#include <span>

#include "energy/energy.h"

namespace aspic {

class TetElasticity;

// A stiffness in a damping matrix: factor K(shape), the elastic Hessian with negative eigenvalues modified.
struct LaggedStiffness {
  const TetElasticity* elasticity = nullptr;  // null: none
  double factor = 0;                          // [s]
  Positions shape;
  Definiteness definiteness = Definiteness::clamped;
};

// Accumulators for the derivatives of w . dD/dx. Empty spans are skipped.
struct DampingGradients {
  std::span<double> start;         // with respect to the start of the step, 3 per vertex
  std::span<double> coefficients;  // with respect to the coefficients of the term, coefficient_count() of them
};

// A dissipation potential D [J] of one time step. -dD/dx is the damping force at the velocity (x - start) / h [N]; both
// are 0 in statics.
class Damping : public Energy {
 public:
  virtual int coefficient_count() const = 0;  // number of coefficients for derivatives; one per tet if they vary
  // Part of the damping matrix that depends on the parameters of an elasticity. Its derivatives are not in
  // add_derivatives().
  virtual LaggedStiffness lagged_stiffness(const Context&) const { return {}; }
  virtual double mass_factor(int /*vertex*/) const { return 0; }  // a in the contribution a/(2h) |x - start|_M^2 to D
  // Adds `scale` times the derivatives of w . dD/dx at x to `gradients`, at a constant lagged_stiffness(); w has 3
  // entries per vertex. Requires a step whose coefficients are evaluated at its start.
  virtual void add_derivatives(Positions x, const Context& context, std::span<const double> w, double scale,
                               const DampingGradients& gradients) const = 0;
};

}  // namespace aspic
