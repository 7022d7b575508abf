#include "fit/checkpointing.h"

#include <algorithm>

#include "base/check.h"

namespace aspic {
namespace {

// beta(s, r) = (s + r)! / (s! r!): longest chain that s slots can reverse with at most r forward repetitions per step;
// 0 for r < 0.
int64_t reach(int slots, int repeats) {
  constexpr int64_t kEnough = int64_t{1} << 32;  // longer than any chain
  if (repeats < 0) return 0;
  int64_t beta = 1;
  for (int i = 1; i <= std::min(slots, repeats) && beta < kEnough; ++i)
    beta = beta * (std::max(slots, repeats) + i) / i;
  return beta;
}

int repeats_for(int steps, int slots) {
  int r = 0;
  while (reach(slots, r) < steps) ++r;
  return r;
}

// Number of steps to the next stored state that minimizes the repetitions of both parts.
int next_store(int steps, int slots) {
  const int r = repeats_for(steps, slots);
  const int64_t behind = std::min(reach(slots - 1, r), steps - reach(slots, r - 2));
  return static_cast<int>(std::clamp<int64_t>(steps - behind, 1, steps - 1));
}

bool advance(int steps, const ChainWalk& walk) {
  for (int i = 0; i < steps; ++i)
    if (!walk.advance()) return false;
  return true;
}

// Reverses points begin ... end - 1 from point `begin`, which is stored in `slot`. There are `slots` slots from there
// on.
bool reverse(int begin, int end, int slot, int slots, const ChainWalk& walk) {
  const int steps = end - begin;
  if (steps == 1) return walk.reverse(begin);
  if (slots == 1) {
    for (int point = end - 1; point >= begin; --point) {
      if (point < end - 1) walk.restore(slot);
      if (!advance(point - begin, walk) || !walk.reverse(point)) return false;
    }
    return true;
  }
  const int middle = begin + next_store(steps, slots);
  if (!advance(middle - begin, walk)) return false;
  walk.store(slot + 1);
  if (!reverse(middle, end, slot + 1, slots - 1, walk)) return false;
  walk.restore(slot);
  return reverse(begin, middle, slot, slots, walk);
}

}  // namespace

bool walk_backwards(int steps, int slots, const ChainWalk& walk) {
  ASPIC_CHECK(slots >= 1);
  if (steps == 0) return true;
  walk.store(0);
  return reverse(0, steps, 0, slots, walk);
}

// r steps - beta(s + 1, r - 1) [Griewank and Walther 2000].
int64_t checkpointing_advances(int steps, int slots) {
  if (steps <= 1) return 0;
  const int r = repeats_for(steps, slots);
  return int64_t{r} * steps - reach(slots + 1, r - 1);
}

}  // namespace aspic
