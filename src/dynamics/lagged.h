#pragma once
#include "dynamics/integrator.h"

namespace aspic {

// Minimizes E, whose lagged coefficients such as normal forces in friction it updates after each minimization until the
// minimizer of one update satisfies the convergence criterion of the next. Without such terms this is one minimization.
// Ends with Status::inaccurate if the coefficients do not settle. Sets solve.passes and solve.decrement.
MinimizeReport minimize_lagged(const StepTools& tools, const MinimizeOptions& options, InitialIterate initial,
                               StepSolve& solve);

}  // namespace aspic
