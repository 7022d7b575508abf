// Continuous collision detection: steps along straight paths that keep a positive gap between two primitives.
#pragma once
#include <array>

#include "mesh/distance.h"

namespace aspic {

// Two primitives whose points move along x + alpha dx, 0 <= alpha <= 1. Points beyond those of `kind` are ignored.
struct MovingPair {
  PairKind kind;
  std::array<Vec3d, 4> x, dx;  // [m]
};

struct StepRule {
  double landing;      // gap at which pairs land [m]; pairs closer than twice this gap land at a fifth of theirs
  double offset = 0;   // sum of the radii of the primitives [m]; the gap is the distance minus this
  double horizon = 1;  // largest alpha of interest, at most 1
};

enum class StepLimit : uint8_t {
  none,        // the pair keeps the landing gap up to the horizon
  gap,         // the pair has the landing gap at alpha
  iterations,  // iteration limit reached: the path beyond alpha is unknown
  resolution   // the gap at alpha = 0 is below 1000 units of round-off of the coordinates, or not finite; alpha = 0
};

struct SafeStep {
  double alpha;
  StepLimit limit;
  int evaluations;  // number of computed distances
};

// Returns an alpha <= horizon such that the gap stays above half the landing gap on [0, alpha], also after x + s dx is
// rounded for any s in [0, alpha]. For the limit `gap`, alpha does not depend on the horizon. Scaling all lengths by a
// power of two leaves alpha unchanged. Combines additive steps [Li, Kaufman, Jiang 2021, algorithm 1] with a bound on
// the separation of all points along the closest direction, which is linear in alpha.
SafeStep largest_step(const MovingPair& pair, const StepRule& rule);

}  // namespace aspic
