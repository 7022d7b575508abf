#pragma once
#include <span>

#include "dynamics/integrator.h"

namespace aspic {

// Positions that move along a line while obstacles move from their positions at one time to those at another [s].
struct ContactPath {
  std::span<const double> from, to;
  double start_time, end_time;
};
// Returns whether no surfaces touch along the path.
bool is_free(const StepTools& tools, const ContactPath& path);

// Boundary-condition continuation: moves the pinned vertices of q from their positions in `from` to those at `time`,
// and obstacles from their positions at the start of the step, while the energy stays finite. If a single move would
// invert elements of a barrier material, or raise the energy beyond the reach of the minimizer, the pins move in
// fractions, each followed by a few iterations for the free vertices. Where moving obstacles push, they advance with
// the free vertices along Newton directions, as far as contact allows. The energy remains infinite if no fraction is
// small enough. Returns E at q and adds the counts to `work`.
Evaluation advance_boundary(const StepTools& tools, double time, std::span<const double> from, std::span<double> q,
                            MinimizeReport& work);

// Adds the counts of `spent` to those of `work`; status and values are unchanged.
void add_work(const MinimizeReport& spent, MinimizeReport& work);

}  // namespace aspic
