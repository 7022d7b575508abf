// The minimization of a time step, or of a stage of one, as a value:
//   E(q) = w/2 (q - q~)' M (q - q~) + f (V(q) + D(q))
//   backward Euler: w = 1, f = h^2, q~ = q_t + h qdot_t          statics: w = 0, f = 1
#pragma once
#include <optional>
#include <span>

#include "energy/energy.h"

namespace aspic {

struct StepProblem {
  std::span<const double> predicted;        // q~ [m]
  double inertia = 1, factor = 1;           // w and f
  std::optional<StepContext> context = {};  // of the terms of V and D, with the obstacles; empty: their last one
  std::span<const double> internal = {};    // internal variables at the start; they must outlive the problem
  double duration = 0;                      // in which they change [s]
  bool counts_pinned_forces = false;  // among those in balance, see Criterion::scale: at rest, nothing else may balance
                                      // the motion of pins
};

}  // namespace aspic
