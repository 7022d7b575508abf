#include "model/checkpointing.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <tuple>

namespace aspic {
namespace {

// A chain whose states are their own numbers, with checks of every call.
struct NumberChain {
  int at = 0, next_reverse;
  int64_t advances = 0;
  size_t most_stored = 0;
  std::map<int, int> slots;

  explicit NumberChain(int steps) : next_reverse(steps - 1) {}
  ChainOperations operations(int slot_count) {
    return {.advance = [this] { return ++at, ++advances, true; },
            .store =
                [this, slot_count](int slot) {
                  EXPECT_TRUE(slot >= 0 && slot < slot_count);
                  slots[slot] = at;
                  most_stored = std::max(most_stored, slots.size());
                },
            .restore = [this](int slot) { at = slots.at(slot); },
            .reverse =
                [this](int step) {
                  EXPECT_EQ(step, next_reverse--);
                  EXPECT_EQ(step, at);
                  return true;
                }};
  }
};

// The minimum number of advances, by trying every place for the next state.
int64_t least_advances(int steps, int slots) {
  static std::map<std::pair<int, int>, int64_t> known;
  if (steps == 1) return 0;
  if (slots == 1) return int64_t{steps} * (steps - 1) / 2;
  const auto [entry, is_new] = known.try_emplace({steps, slots}, std::numeric_limits<int64_t>::max());
  if (!is_new) return entry->second;
  int64_t least = std::numeric_limits<int64_t>::max();
  for (int middle = 1; middle < steps; ++middle)
    least = std::min(least, middle + least_advances(steps - middle, slots - 1) + least_advances(middle, slots));
  return known[{steps, slots}] = least;
}

TEST(Checkpointing, TakesMinimumNumberOfSteps) {
  for (int slots = 1; slots <= 9; ++slots)
    for (int steps = 1; steps <= 120; ++steps) {
      NumberChain chain(steps);
      EXPECT_TRUE(reverse_chain(steps, slots, chain.operations(slots)));
      EXPECT_EQ(chain.next_reverse, -1);
      EXPECT_LE(chain.most_stored, static_cast<size_t>(slots));
      EXPECT_EQ(chain.advances, least_advances(steps, slots)) << steps << " steps, " << slots << " states";
    }
}

TEST(Checkpointing, ReversesLongChainsWithFewRepeats) {
  // r steps - (s + r)! / ((s + 1)! (r - 1)!) [Griewank and Walther 2000]; r = 7; 1, everything is stored; 4.
  for (const auto& [steps, slots, advances] :
       {std::tuple{10'000, 10, 57'624}, {1'000, 1'000, 999}, {50'000, 40, 186'756}}) {
    NumberChain chain(steps);
    EXPECT_TRUE(reverse_chain(steps, slots, chain.operations(slots)));
    EXPECT_EQ(chain.advances, advances);
  }
}

TEST(Checkpointing, EndsAtFailedStep) {
  for (const int steps : {0, 1, 7}) {
    NumberChain chain(steps);
    ChainOperations operations = chain.operations(3);
    operations.reverse = [](int step) { return step != 0; };
    EXPECT_EQ(reverse_chain(steps, 3, operations), steps == 0);
    operations.advance = [] { return false; };
    EXPECT_EQ(reverse_chain(steps, 3, operations), steps == 0);
  }
}

}  // namespace
}  // namespace aspic
