#include "model/local_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace aspic {
namespace {

std::vector<Vec3d> random_points(int count, double height) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) points.push_back({{uniform(random), uniform(random), height * uniform(random)}});
  return points;
}

MotionNeighbors by_sorting(const std::vector<Vec3d>& points, int i) {
  std::vector<std::pair<double, int>> all;
  for (int j = 0; j < static_cast<int>(points.size()); ++j)
    if (j != i) all.emplace_back(squared_norm(points[j] - points[i]), j);
  std::sort(all.begin(), all.end());
  MotionNeighbors nearest{};
  for (int k = 0; k < kMotionNeighbors; ++k) nearest[k] = all[k].second;
  return nearest;
}

TEST(NearestPoints, EqualSortedDistances) {
  for (const double height : {1.0, 0.0}) {
    std::vector<Vec3d> points = random_points(700, height);
    for (int i = 0; i < 30; ++i) points.push_back(points[0]);  // more copies than neighbors
    const std::vector<MotionNeighbors> nearest = nearest_points(points);
    for (int i = 0; i < static_cast<int>(points.size()); ++i) EXPECT_EQ(nearest[i], by_sorting(points, i)) << i;
  }
}

TEST(ExpectedMotion, ReproducesLinearFieldsDespiteOutliers) {
  const std::vector<Vec3d> points = random_points(200, 1);
  const std::vector<MotionNeighbors> near = nearest_points(points);
  std::vector<Vec3d> motion;
  for (const Vec3d& X : points) motion.push_back({{0.1 * X[0] + 0.02 * X[2], -0.03 * X[1], 0.01}});
  motion[near[7][2]] = {{5, 5, 5}};
  const ExpectedMotion expected = expected_motion(points, motion, 7, near[7]);
  EXPECT_LT(norm(expected.u - motion[7]), 0.01);
  EXPECT_LT(expected.spread, 0.01);
}

}  // namespace
}  // namespace aspic
