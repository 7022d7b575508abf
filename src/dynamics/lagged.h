#pragma once
#include "dynamics/integrator.h"

namespace aspic {

// Minimizes E and updates its lagged coefficients, such as the normal forces in friction, or evaluates them once at
// options.lag_at. Sets solve.passes and solve.decrement.
MinimizeReport minimize_lagged(const StepTools& tools, const MinimizeOptions& options, InitialIterate initial,
                               StepSolve& solve);

}  // namespace aspic
