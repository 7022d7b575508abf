#include "viewer/pacing.h"

#include <gtest/gtest.h>

namespace aspic::viewer {
namespace {

using std::chrono::milliseconds;
using Time = Pacing::Clock::time_point;

const Time kStart = Time() + std::chrono::hours(1);

TEST(Pacing, FollowsTheSpeedAfterTheFirstStep) {
  Pacing pacing;
  EXPECT_EQ(pacing.due(0, 0.5, kStart), kStart);
  for (int step = 1; step <= 10; ++step) {
    const Time due = pacing.due(0.01 * step, 0.5, kStart + milliseconds(20 * step - 15));
    EXPECT_NEAR((due - kStart) / milliseconds(1), 20 * step, 1);
  }
}

TEST(Pacing, CatchesUpWithSmallDelaysOnly) {
  Pacing pacing;
  pacing.due(0, 1, kStart);
  EXPECT_LT(pacing.due(0.01, 1, kStart + milliseconds(50)), kStart + milliseconds(50));
  const Time late = kStart + milliseconds(5000);
  EXPECT_EQ(pacing.due(0.02, 1, late), late);
  EXPECT_GT(pacing.due(0.03, 1, late), late);
}

TEST(Pacing, RestartsAtAnotherSpeedOrEarlierTime) {
  Pacing pacing;
  pacing.due(1, 1, kStart);
  EXPECT_GT(pacing.due(1.5, 1, kStart), kStart);
  EXPECT_EQ(pacing.due(1.5, 2, kStart), kStart);
  EXPECT_EQ(pacing.due(0.2, 2, kStart), kStart);
}

TEST(Rate, IsSimulatedTimePerWallTime) {
  Rate rate;
  rate.start(1, kStart);
  EXPECT_FALSE(rate.update(1.1, kStart + milliseconds(100)));
  EXPECT_TRUE(rate.update(1.5, kStart + milliseconds(1000)));
  EXPECT_DOUBLE_EQ(rate.value(), 0.5);
  EXPECT_TRUE(rate.update(0, kStart + milliseconds(2000)));  // rewound
  EXPECT_EQ(rate.value(), 0);
}

}  // namespace
}  // namespace aspic::viewer
