// What backward Euler guarantees of every step, whatever its length. Its E at the new positions is not above E at the
// old ones (v = 0), which says
//   V_(t+1) + 1/2 |v_(t+1) - v_t|_M^2  <=  V_t + T_t + W,   W: the work of moving targets.
// The left side comes from the ledger and E from the minimiser: a step that breaks the bound shows a wrong energy.
#pragma once
#include <string_view>

namespace aspic {

enum class EnergyBound {
  none,            // another scheme, or a step that was divided or dropped
  not_guaranteed,  // pins moved, or the minimiser ended above E at v = 0
  holds,
  broken,
};
std::string_view to_string(EnergyBound bound);

// What the ledger knows of a step of backward Euler. [J]
struct BoundedEnergies {
  double allowed = 0;    // V_t + T_t + W
  double reached = 0;    // V_(t+1) + 1/2 |v_(t+1) - v_t|_M^2
  double magnitude = 0;  // of the sums that these were made of
  bool pins_moved = false;
};

// `accepted`: the minimiser's E divided by h^2 [J].
EnergyBound energy_bound(const BoundedEnergies& energies, double accepted);

}  // namespace aspic
