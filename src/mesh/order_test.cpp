#include "mesh/order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "mesh/generators.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

double path_length(const std::vector<Vec3d>& points, const std::vector<int>& order) {
  double sum = 0;
  for (size_t i = 1; i < order.size(); ++i) sum += norm(points[order[i]] - points[order[i - 1]]);
  return sum;
}

TEST(MortonOrder, VisitsCubeCornersWithXFastest) {
  const std::vector<Vec3d> corners = {{{1, 1, 1}}, {{0, 0, 0}}, {{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};
  EXPECT_EQ(morton_order(corners), (std::vector<int>{1, 3, 4, 2, 0}));
}

TEST(MortonOrder, IsPermutationThatShortensPathThroughMesh) {
  const std::vector<Vec3d> centers = centroids(make_box({{0, 0, 0}}, {{1, 1, 1}}, {16, 16, 16}));
  std::vector<int> order = morton_order(centers), natural(centers.size());
  std::iota(natural.begin(), natural.end(), 0);
  std::vector<int> shuffled = natural;
  for (size_t i = 0; i < shuffled.size(); ++i) shuffled[i] = static_cast<int>(i * 7919 % shuffled.size());
  EXPECT_LT(path_length(centers, order), 0.1 * path_length(centers, shuffled));
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, natural);
}

TEST(MortonOrder, KeepsOrderOfEqualPointsAndAcceptsNan) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3d> points = {{{1, 1, 1}}, {{1, 1, 1}}, {{nan, 0, 0}}, {{1, 1, 1}}};
  EXPECT_EQ(morton_order(points), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_TRUE(morton_order({}).empty());
}

TEST(MortonOrder, KeepsOrderOfPointsWithOverflowingDistances) {
  EXPECT_EQ(morton_order(std::vector<Vec3d>{{{1e308, 1, 1}}, {{-1e308, 0, 0}}, {{0, 0, 0}}}),
            (std::vector<int>{0, 1, 2}));
}

TEST(HilbertOrder, StepsFromCellToNeighboringCell) {
  std::vector<Vec3d> grid;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      for (int k = 0; k < 8; ++k) grid.push_back({{double(i), double(j), double(k)}});
  grid.push_back({{8, 8, 8}});  // aligns the cells of the curve with the grid
  const std::vector<int> order = hilbert_order(grid);
  for (size_t i = 1; i < order.size(); ++i) {
    if (order[i] == 512 || order[i - 1] == 512) continue;
    EXPECT_EQ(norm(grid[order[i]] - grid[order[i - 1]]), 1) << i;
  }
}

TEST(HilbertOrder, IsPermutationAndKeepsOrderOfEqualPoints) {
  std::vector<int> order = hilbert_order(centroids(make_box({{0, 0, 0}}, {{1, 1, 1}}, {5, 5, 5})));
  std::sort(order.begin(), order.end());
  for (size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], static_cast<int>(i));
  EXPECT_EQ(hilbert_order(std::vector<Vec3d>(3, {{1, 2, 3}})), (std::vector<int>{0, 1, 2}));
}

}  // namespace
}  // namespace aspic
