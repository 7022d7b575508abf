#include "base/check.h"

#include <gtest/gtest.h>

namespace aspic {
namespace {

TEST(CheckDeathTest, ViolationNamesPlaceAndConditionAndAborts) {
  EXPECT_DEATH(check_failed("n == 3", "mesh.cpp", 7), "mesh.cpp:7: a bug in Aspic: n == 3 does not hold");
}

TEST(CheckDeathTest, ChecksFollowTheBuildType) {
  int evaluated = 0;
  ASPIC_CHECK(++evaluated == 1);
#if defined(ASPIC_ENABLE_CHECKS)
  EXPECT_EQ(evaluated, 1);
  EXPECT_DEATH(ASPIC_CHECK(evaluated == 2), "evaluated == 2 does not hold");
#else
  EXPECT_EQ(evaluated, 0);
#endif
}

}  // namespace
}  // namespace aspic
