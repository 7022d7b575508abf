#include "math/vectors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"

namespace aspic {
namespace {

TEST(Vectors, DotIsBitReproducible) {
  std::vector<double> x(10'000), y(10'000);
  for (size_t i = 0; i < x.size(); ++i)
    x[i] = std::sin(static_cast<double>(i)), y[i] = std::cos(0.7 * static_cast<double>(i));
  set_thread_count(1);
  const double serial = dot(x, y);
  set_thread_count(4);
  EXPECT_EQ(dot(x, y), serial);
  EXPECT_EQ(dot({}, {}), 0);
}

TEST(Vectors, NormsOfKnownVectors) {
  const std::vector<double> x = {3, 0, -4};
  EXPECT_EQ(norm(x), 5);
  EXPECT_EQ(max_abs(x), 4);
  EXPECT_EQ(max_abs({}), 0);
}

TEST(Vectors, MaxAbsPropagatesNaN) {
  EXPECT_TRUE(std::isnan(max_abs(std::vector<double>{1, NAN, 2})));
  EXPECT_TRUE(std::isnan(max_abs(std::vector<double>{NAN})));
  EXPECT_EQ(max_abs(std::vector<double>{1, -INFINITY}), INFINITY);
}

TEST(Vectors, AddScaledAddsInPlace) {
  std::vector<double> y = {1, 2};
  add_scaled(3, std::vector<double>{10, -1}, y);
  EXPECT_EQ(y, (std::vector<double>{31, -1}));
}

TEST(Vectors, MedianOfOddAndEvenCounts) {
  EXPECT_EQ(median({5, 1, 3}), 3);
  EXPECT_EQ(median({4, 1, 3, 100}), 3.5);
  EXPECT_EQ(median({7}), 7);
  EXPECT_EQ(median({}), 0);
}

}  // namespace
}  // namespace aspic
