#include "base/huge_pages.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace aspic {
namespace {

TEST(LargeVector, KeepsItsElementsWhenItGrowsIntoHugePages) {
  LargeVector<double> values;
  const size_t count = 3 * HugePages<double>::kLarge + 1;
  for (size_t i = 0; i < count; ++i) values.push_back(static_cast<double>(i));
  for (size_t i = 0; i < count; ++i) ASSERT_EQ(values[i], static_cast<double>(i));
  const LargeVector<double> copy = values;
  EXPECT_EQ(copy, values);
#ifdef __linux__
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(copy.data()) % (2 << 20), 0U);  // starts at a huge page
#endif
}

}  // namespace
}  // namespace aspic
