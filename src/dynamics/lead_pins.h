#pragma once
#include <span>

#include "dynamics/integrator.h"

namespace aspic {

// Positions that move along a line while obstacles move from their place at one time to that at another one [s].
struct ContactPath {
  std::span<const double> from, to;
  double start_time, end_time;
};
// Returns whether nothing touches along the path.
bool is_free(const StepTools& tools, const ContactPath& path);

// Boundary-condition continuation: moves the pinned vertices of q from their positions in `from` to those at `time`,
// and obstacles from those at the start of the step, and keeps the energy finite. If that would invert elements of a
// barrier material, the pins move in fractions, and a few iterations move the free vertices after each. The energy
// stays infinite if no fraction is small enough. Returns E at q and adds the counts to `work`.
Evaluation lead_pins(const StepTools& tools, double time, std::span<const double> from, std::span<double> q,
                     MinimizeReport& work);

// Adds the counts of `spent` to those of `work`; status and values stay.
void add_work(const MinimizeReport& spent, MinimizeReport& work);

}  // namespace aspic
