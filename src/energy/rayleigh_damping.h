// Rayleigh damping as an incremental potential: D(x) = 1/(2h) (x - x_start)' C (x - x_start), C = a M + b K(x_start),
// whose gradient is C v. K is the elastic Hessian at the start of the step with negative eigenvalues clamped.
#pragma once
#include <memory>

#include "energy/damping.h"
#include "energy/mass.h"
#include "energy/tet_elasticity.h"

namespace aspic {

// Its coefficients are a and, where it is not 0, b.
std::unique_ptr<Damping> make_rayleigh_damping(const MassMatrix& mass, double mass_factor /* a [1/s] */,
                                               const TetElasticity* elasticity, double stiffness_factor /* b [s] */);

}  // namespace aspic
