// Rayleigh damping as an incremental potential: D(x) = 1/(2h) (x - x_start)' C (x - x_start) with C = a M + b
// K(x_start) and the gradient C v. K is the elastic Hessian at the start of the step with negative eigenvalues clamped.
#pragma once
#include <memory>

#include "energy/damping.h"
#include "energy/mass.h"
#include "energy/tet_elasticity.h"

namespace aspic {

// Returns the damping term. The coefficients of the term are a and, if it is not 0, b. `elasticity` may be null if b =
// 0. Mass and elasticity must outlive the term.
std::unique_ptr<Damping> make_rayleigh_damping(const MassMatrix& mass, double mass_factor /* a [1/s] */,
                                               const TetElasticity* elasticity, double stiffness_factor /* b [s] */);

}  // namespace aspic
