// Rayleigh damping as an incremental potential: D(x) = 1/(2h) (x - x_start)' C (x - x_start), C = a M + b K(x_start),
// whose gradient is C v. K is the elastic Hessian at the start of the step with negative eigenvalues clamped.
#pragma once
#include <memory>

#include "energy/energy.h"
#include "energy/mass.h"

namespace aspic {

std::unique_ptr<Energy> make_rayleigh_damping(const MassMatrix& mass, double mass_factor /* a [1/s] */,
                                              const Energy* elasticity, double stiffness_factor /* b [s] */);

}  // namespace aspic
