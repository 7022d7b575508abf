// A chain of steps in reverse with few of its states stored: binomial checkpointing [Griewank and Walther 2000].
#pragma once
#include <cstdint>
#include <functional>

namespace aspic {

// What the walk asks of a walker, who stands at a point of the chain. Points are 0 ... steps; step i leads from point i
// to i + 1.
struct ChainWalk {
  std::function<bool()> advance;          // one step forward; false: it failed, which ends the walk
  std::function<void(int slot)> store;    // the state where the walker stands
  std::function<void(int slot)> restore;  // it again
  // The walker stands at point `step`, and everything from step + 1 on was reversed. The first one, steps - 1, takes
  // the last step of the chain forward before. False: ends the walk.
  std::function<bool(int step)> reverse;
};

// From point 0, where the walker stands: reverse(steps - 1), reverse(steps - 2) ... reverse(0). At most `slots` (at
// least 1) states are stored at a time, in slots 0 ... slots - 1, and advance() is called as rarely as is possible
// then. False: a call failed.
bool walk_backwards(int steps, int slots, const ChainWalk& walk);

// How often advance() is called.
int64_t checkpointing_advances(int steps, int slots);

}  // namespace aspic
