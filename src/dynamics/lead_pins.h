#pragma once
#include <span>

#include "dynamics/integrator.h"

namespace aspic {

// Moves the pinned vertices of q, which stand as in `from`, to where they are at the time, and keeps the
// energy finite: where that would turn elements of a barrier material inside out, the pins go in parts, and after each
// part the free vertices follow by a few iterations. The energy stays infinite when no part is small enough. Returns E
// at q, and adds what was spent to `work`.
Evaluation lead_pins(const StepTools& tools, double time, std::span<const double> from, std::span<double> q,
                     MinimizeReport& work);

// Adds the counts of `spent` to those of `work`; status and values stay.
void add_work(const MinimizeReport& spent, MinimizeReport& work);

}  // namespace aspic
