#include "model/checkpointing.h"

#include <algorithm>

#include "base/check.h"

namespace aspic {
namespace {

// beta(s, r) = (s + r)! / (s! r!): the length of the longest chain that s slots can reverse if each step is taken
// forward at most r times; 0 for r < 0.
int64_t reach(int slots, int repeats) {
  constexpr int64_t kEnough = int64_t{1} << 32;  // more than the steps of any chain
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

// Returns the number of steps before the next stored state, so that both parts are reversed with the fewest repeats.
int steps_to_next_store(int steps, int slots) {
  const int r = repeats_for(steps, slots);
  const int64_t behind = std::min(reach(slots - 1, r), steps - reach(slots, r - 2));
  return static_cast<int>(std::clamp<int64_t>(steps - behind, 1, steps - 1));
}

bool advance(int steps, const ChainOperations& chain) {
  for (int i = 0; i < steps; ++i)
    if (!chain.advance()) return false;
  return true;
}

// Reverses the steps begin ... end - 1. The current state is at point `begin` and stored in `slot`, the first of
// `slots` slots.
bool reverse(int begin, int end, int slot, int slots, const ChainOperations& chain) {
  const int steps = end - begin;
  if (steps == 1) return chain.reverse(begin);
  if (slots == 1) {
    for (int point = end - 1; point >= begin; --point) {
      if (point < end - 1) chain.restore(slot);
      if (!advance(point - begin, chain) || !chain.reverse(point)) return false;
    }
    return true;
  }
  const int middle = begin + steps_to_next_store(steps, slots);
  if (!advance(middle - begin, chain)) return false;
  chain.store(slot + 1);
  if (!reverse(middle, end, slot + 1, slots - 1, chain)) return false;
  chain.restore(slot);
  return reverse(begin, middle, slot, slots, chain);
}

}  // namespace

bool reverse_chain(int steps, int slots, const ChainOperations& chain) {
  ASPIC_CHECK(slots >= 1);
  if (steps == 0) return true;
  chain.store(0);
  return reverse(0, steps, 0, slots, chain);
}

}  // namespace aspic
