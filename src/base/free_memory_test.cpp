#include "base/free_memory.h"

#include <gtest/gtest.h>

namespace aspic {
namespace {

TEST(FreeMemory, IsPlausible) {
  EXPECT_GT(free_memory(), 1 << 20);  // this test runs, so some is free
#ifdef __linux__
  EXPECT_LT(free_memory(), int64_t{1} << 50);  // a number was found, in bytes
#endif
}

}  // namespace
}  // namespace aspic
