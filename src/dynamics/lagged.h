#pragma once
#include "dynamics/integrator.h"

namespace aspic {

// Minimizes E. Updates its lagged coefficients, such as the normal forces in friction, after each minimization, until
// the minimizer for one update satisfies the convergence criterion of the next. Without lagged terms, performs one
// minimization. Ends with Status::inaccurate if the coefficients do not converge. Sets solve.passes and
// solve.decrement.
MinimizeReport minimize_lagged(const StepTools& tools, const MinimizeOptions& options, InitialIterate initial,
                               StepSolve& solve);

}  // namespace aspic
