#include "base/free_memory.h"

#include <gtest/gtest.h>

namespace aspic {
namespace {

TEST(FreeMemory, IsPlausible) {
  EXPECT_GT(free_memory(), 1 << 20);  // some memory is free, because this test runs
#ifdef __linux__
  EXPECT_LT(free_memory(), int64_t{1} << 50);  // a limit was found, in bytes
#endif
}

}  // namespace
}  // namespace aspic
