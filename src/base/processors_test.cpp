#include "base/processors.h"

#include <gtest/gtest.h>

#include <thread>

#if defined(__linux__)
#include <sched.h>
#endif

namespace aspic {
namespace {

TEST(Processors, AreBetweenOneAndMachineCount) {
  EXPECT_GE(processor_count(), 1);
  if (const unsigned all = std::thread::hardware_concurrency(); all > 0) {
    EXPECT_LE(processor_count(), static_cast<int>(all));
  }
}

#if defined(__linux__)
TEST(Processors, RespectAffinityMask) {
  int count = 0;
  std::thread([&] {  // the mask belongs to the thread
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    count = processor_count();
  })
      .join();
  EXPECT_EQ(count, 1);
}
#endif

}  // namespace
}  // namespace aspic
