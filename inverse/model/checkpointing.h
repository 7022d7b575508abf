// Reversal of a chain of steps with few stored states: binomial checkpointing [Griewank and Walther 2000].
#pragma once
#include <cstdint>
#include <functional>

namespace aspic {

// Operations on the current state, which is at one point of the chain. Points are 0 ... steps; step i leads from point
// i to i + 1. A callback that returns false has failed and ends the reversal.
struct ChainOperations {
  std::function<bool()> advance;          // takes one step forward
  std::function<void(int slot)> store;    // stores the current state
  std::function<void(int slot)> restore;  // replaces the current state by a stored one
  // Reverses one step. The current state is at point `step`, and all later steps have been reversed. The first call,
  // for steps - 1, must also take the last step of the chain forward.
  std::function<bool(int step)> reverse;
};

// Calls reverse(steps - 1), reverse(steps - 2) ... reverse(0). The current state is at point 0 at first. At most
// `slots` (at least 1) states are stored at a time, in slots 0 ... slots - 1, with the minimum number of calls of
// advance() for that [Griewank and Walther 2000]. Returns false if a callback failed.
bool reverse_chain(int steps, int slots, const ChainOperations& chain);

}  // namespace aspic
