// Reversal of a chain of steps with few stored states: binomial checkpointing [Griewank and Walther 2000].
#pragma once
#include <cstdint>
#include <functional>

namespace aspic {

// Callbacks of a reversal. The chain has points 0 ... steps; step i leads from point i to i + 1.
struct ChainWalk {
  std::function<bool()> advance;          // one step forward; false: failure, which ends the reversal
  std::function<void(int slot)> store;    // stores the current state
  std::function<void(int slot)> restore;  // restores a stored state
  // Reverses step `step`; the state is that of point `step`, and all later steps are reversed. The first call, for
  // steps - 1, also makes the last forward step. False: ends the reversal.
  std::function<bool(int step)> reverse;
};

// Starts at point 0 and calls reverse(steps - 1), reverse(steps - 2) ... reverse(0). Stores at most `slots` (>= 1)
// states at a time, in slots 0 ... slots - 1, with the minimum number of advance() calls. Returns false if a callback
// failed.
bool walk_backwards(int steps, int slots, const ChainWalk& walk);

// Number of advance() calls.
int64_t checkpointing_advances(int steps, int slots);

}  // namespace aspic
