// Continuous collision detection: steps along straight paths that keep a positive gap between two primitives.
#pragma once
#include <array>

#include "mesh/distance.h"

namespace aspic {

// Two primitives whose points move along x + alpha dx, 0 <= alpha <= 1. Points beyond those of the kind are ignored.
struct MovingPair {
  PairKind kind;
  std::array<Vec3d, 4> x, dx;  // [m]
};

struct StepRule {
  double landing;      // gap at which pairs from farther than twice this gap land [m]; others land at a fifth of theirs
  double offset = 0;   // sum of the radii of the primitives; the gap is the distance minus this [m]
  double horizon = 1;  // largest alpha of interest, at most 1
};

enum class StepLimit : uint8_t {
  none,        // the pair keeps the landing gap up to the horizon
  gap,         // the pair has the landing gap at alpha
  iterations,  // more steps than the limit: the path beyond alpha is unknown
  resolution   // the gap at alpha = 0 is less than 1000 units of round-off of the coordinates, or not finite; alpha = 0
};

struct SafeStep {
  double alpha;
  StepLimit limit;
  int evaluations;  // distances computed
};

// Returns an alpha <= horizon such that the gap stays above half the landing gap on [0, alpha], also after x + s dx is
// rounded for any s in [0, alpha]. The alpha of a pair with limit `gap` does not depend on the horizon. Scaling all
// lengths by a power of two leaves alpha unchanged. Combines additive steps [Li, Kaufman, Jiang 2021, algorithm 1] with
// the separation of all points along the closest direction, which is linear in alpha.
SafeStep largest_step(const MovingPair& pair, const StepRule& rule);

}  // namespace aspic
