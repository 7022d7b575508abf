// What backward Euler guarantees of every step, whatever its length. Its E at the new positions is not above E at the
// old ones (v = 0), which says
//   V_(t+1) + 1/2 |v_(t+1) - v_t|_M^2  <=  V_t + T_t + W,   W: the work of moving targets.
// Pins that move are where they will be, and the rest of the body where it was, in the positions q_s with which E is
// compared: with u = (q_s - q_t) / h, which is zero but for pins, the right side is
//   V(q_s) + D(q_s) + 1/2 |u - v_t|_M^2,   D: the potential of damping; targets are where they end.
// Both sides come from the ledger and E from the minimizer: a step that breaks the bound shows a wrong energy.
#pragma once
#include "dynamics/step_report.h"

namespace aspic {

// What the ledger knows of a step of backward Euler. [J]
struct BoundedEnergies {
  double allowed = 0;    // the right side
  double reached = 0;    // V_(t+1) + 1/2 |v_(t+1) - v_t|_M^2
  double magnitude = 0;  // of the sums that these were made of
  double round_off = 0;  // of velocities, which are differences of positions, and of strains beside 1
};

// `accepted`: the minimizer's E divided by h^2 [J].
EnergyBound energy_bound(const BoundedEnergies& energies, double accepted);

// Judges a step of backward Euler, or one more part of it, by the minimizer's E divided by h^2 [J]. Of parts the report
// keeps the worst verdict and the smallest slack.
void judge(const BoundedEnergies& bounded, double accepted, StepReport& report);

}  // namespace aspic
