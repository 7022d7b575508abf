// Energy bound of backward Euler, valid for steps of any length. E at the new positions is at most E at the old
// positions (v = 0), so
//   V_(t+1) + 1/2 |v_(t+1) - v_t|_M^2  <=  V_t + T_t + W,   W: work of moving targets.
// With moving pins, the comparison uses the positions q_s: pinned vertices at the end of the step, free ones at its
// start. With u = (q_s - q_t) / h, which is zero except at pins, the right side is
//   V(q_s) + D(q_s) + 1/2 |u - v_t|_M^2,   D: damping potential; moving targets at the end of the step.
// With internal variables, V includes their stored energy, whose gain is at most D(q_(t+1)) - D(q_t).
// The ledger supplies both sides; the minimizer supplies E. A violated bound reveals an incorrect energy.
#pragma once
#include "dynamics/step_report.h"

namespace aspic {

// Both sides of the bound for one step, from the ledger [J].
struct BoundedEnergies {
  double allowed = 0;    // right side
  double reached = 0;    // V_(t+1) + 1/2 |v_(t+1) - v_t|_M^2
  double magnitude = 0;  // sum of the magnitudes of the terms
  double round_off = 0;  // rounding error from differences of positions in velocities and strains
};

// `accepted`: E of the minimizer divided by h^2 [J].
EnergyBound energy_bound(const BoundedEnergies& energies, double accepted);

// Checks a step or substep of backward Euler. `accepted`: E of the minimizer divided by h^2 [J]. The report keeps the
// worst result and the smallest slack of all substeps.
void check_energy_bound(const BoundedEnergies& bounded, double accepted, StepReport& report);

}  // namespace aspic
