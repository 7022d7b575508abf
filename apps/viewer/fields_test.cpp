#include "viewer/fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace aspic::viewer {
namespace {

Mat3d random_gradient(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Mat3d F;
  for (double& entry : F.a) entry = normal(random);
  return F;
}

TEST(Stretches, LargestByCosineFormulaEqualsEigenvalue) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Mat3d F = random_gradient(random);
    const double largest = stretches(F)[0];
    EXPECT_NEAR(largest_stretch(F), largest, 1e-7 * largest);
  }
}

TEST(Stretches, LargestIsRightForEqualStretches) {
  const double cases[][3] = {{2, 2, 2}, {2, 2, 1}, {2, 1, 1}, {2, 2, 0}, {2, 0, 0}, {2, -2, 1}};
  for (const auto& diagonal : cases) {
    Mat3d F{};
    for (int i = 0; i < 3; ++i) F(i, i) = diagonal[i];
    EXPECT_NEAR(largest_stretch(F), 2, 1e-7) << diagonal[0] << " " << diagonal[1] << " " << diagonal[2];
  }
  EXPECT_EQ(largest_stretch(Mat3d{}), 0);
}

TEST(Stretches, LargestIsNotFiniteForInfiniteF) {
  Mat3d F = identity3<double>();
  F(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(std::isfinite(largest_stretch(F)));
}

}  // namespace
}  // namespace aspic::viewer
