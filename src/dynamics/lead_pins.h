#pragma once
#include <span>

#include "dynamics/integrator.h"

namespace aspic {

// Boundary-condition continuation: moves the pinned vertices of q from their positions in `from` to those at `time` and
// keeps the energy finite. If that would invert elements of a barrier material, the pins move in fractions, and a few
// iterations move the free vertices after each. The energy stays infinite if no fraction is small enough. Returns E at
// q and adds the counts to `work`.
Evaluation lead_pins(const StepTools& tools, double time, std::span<const double> from, std::span<double> q,
                     MinimizeReport& work);

// Adds the counts of `spent` to those of `work`; status and values stay.
void add_work(const MinimizeReport& spent, MinimizeReport& work);

}  // namespace aspic
