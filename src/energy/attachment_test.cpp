#include "energy/attachment.h"

#include <gtest/gtest.h>

#include "energy/sheet_grid_test.h"

namespace aspic {
namespace {

// Vertices of the first row of a grid on points of its last rows: of a triangle, an edge, a vertex and a tet.
std::vector<AttachedVertex> four_attached(double rest_length) {
  return {{0, 3, {15, 16, 19}, {0.2, 0.3, 0.5}, 7, rest_length},
          {1, 2, {17, 16}, {0.25, 0.75}, 5, rest_length},
          {2, 1, {18}, {1}, 3, rest_length},
          {3, 4, {12, 11, 17, 13}, {0.1, 0.2, 0.3, 0.4}, 2, rest_length}};
}
SheetGrid grid_of_attached() { return sheet_grid(3, 4, 0.5, 0.2); }

TEST(Attachment, DerivativesMatchDifferences) {
  const std::vector<double> x = shaken_sheet(grid_of_attached(), 0.2);
  for (const double rest_length : {0.0, 0.3, 4.0}) {
    Attachment V(four_attached(rest_length));
    expect_sheet_derivatives(V, x, 0.1);
  }
}

TEST(Attachment, ConservesMomenta) {
  const std::vector<double> x = shaken_sheet(grid_of_attached(), 0.2);
  for (const double rest_length : {0.0, 0.3}) {
    const Attachment V(four_attached(rest_length));
    const std::vector<double> g = gradient_of(V, x);
    Vec3d force{}, torque{};
    for (int v = 0; v < static_cast<int>(x.size() / 3); ++v) {
      force = force + point(g, v);
      torque = torque + cross(point(x, v), point(g, v));
    }
    EXPECT_LT(norm(force), 1e-14);
    EXPECT_LT(norm(torque), 1e-14);
    EXPECT_NEAR(V.value(moved_rigidly(x)), V.value(x), 1e-14 * V.value(x));
  }
}

TEST(Attachment, GapIsLargestDeviation) {
  std::vector<double> x(9, 0.0);
  x[0] = 3, x[5] = 4;
  EXPECT_DOUBLE_EQ(Attachment({{0, 1, {2}, {1}, 1, 0}, {1, 1, {2}, {1}, 1, 0}}).largest_gap(x), 4);
  EXPECT_DOUBLE_EQ(Attachment({{0, 2, {1, 2}, {0.5, 0.5}, 1, 6}}).largest_gap(x), 6 - std::sqrt(13));
}

TEST(Attachment, ModifiesOnlyCompressedSprings) {
  const std::vector<double> x = shaken_sheet(grid_of_attached(), 0.2);
  Attachment close(four_attached(0)), compressed(four_attached(4));
  EXPECT_EQ(dense_hessian(close, x, Definiteness::clamped).modified, 0);
  const DenseHessian clamped = dense_hessian(compressed, x, Definiteness::clamped);
  EXPECT_EQ(clamped.modified, 4);
  EXPECT_GT(clamped.eigenvalues().minCoeff(), -1e-13 * clamped.eigenvalues().maxCoeff());
}

TEST(Attachment, HasEqualBitsForThreads) {
  Attachment V(four_attached(0.3));
  expect_equal_bits_for_threads(V, shaken_sheet(grid_of_attached(), 0.2));
}

}  // namespace
}  // namespace aspic
