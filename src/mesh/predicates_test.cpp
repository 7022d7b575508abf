#include "mesh/predicates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace aspic {
namespace {

TEST(Orientation, IsPositiveForCounterClockwiseAndPositiveDeterminants) {
  EXPECT_EQ(orientation(Vec2d{0, 0}, Vec2d{1, 0}, Vec2d{0, 1}), 1);
  EXPECT_EQ(orientation(Vec2d{0, 0}, Vec2d{0, 1}, Vec2d{1, 0}), -1);
  EXPECT_EQ(orientation(Vec3d{{1, 0, 0}}, Vec3d{{0, 1, 0}}, Vec3d{{0, 0, 1}}, Vec3d{{0, 0, 0}}), 1);
  EXPECT_EQ(orientation(Vec3d{{0, 1, 0}}, Vec3d{{1, 0, 0}}, Vec3d{{0, 0, 1}}, Vec3d{{0, 0, 0}}), -1);
}

TEST(Orientation, DetectsOneUnitInLastPlace) {
  // Points on the line y = x and one ulp away, where rounding corrupts the determinant [Kettner et al. 2008].
  const Vec2d b = {12, 12}, c = {24, 24};
  EXPECT_EQ(orientation(Vec2d{0.5, 0.5}, b, c), 0);
  EXPECT_EQ(orientation(Vec2d{0.5, std::nextafter(0.5, 1)}, b, c), 1);
  EXPECT_EQ(orientation(Vec2d{std::nextafter(0.5, 1), 0.5}, b, c), -1);
}

TEST(Orientation, IsZeroForCoplanarPointsInAnyOrder) {
  // Integer points of the plane through p spanned by u and v, far from the origin: coordinates are exact, products of
  // the determinant are not.
  std::mt19937 random(5);
  std::uniform_int_distribution<int> integer(-1000000, 1000000), large(-100000, 100000);
  for (int trial = 0; trial < 200; ++trial) {
    const auto vector = [&] {
      return Vec3d{{double(integer(random)), double(integer(random)), double(integer(random))}};
    };
    const Vec3d p = 1e6 * vector(), u = vector(), v = vector();
    const auto point = [&] { return p + double(large(random)) * u + double(large(random)) * v; };
    const Vec3d a = point(), b = point(), c = point();
    Vec3d d = point();
    ASSERT_EQ(orientation(a, b, c, d), 0);
    ASSERT_EQ(orientation(c, d, a, b), 0);
    d[0] += 1;  // off the plane, unless it contains the x axis
    const int side = orientation(a, b, c, d);
    ASSERT_NE(side, 0);
    ASSERT_EQ(orientation(b, a, c, d), -side);
    ASSERT_EQ(orientation(b, c, a, d), side);
    ASSERT_EQ(orientation(d, b, c, a), -side);
  }
}

TEST(Orientation, AgreesWithIntegerArithmetic) {
  std::mt19937 random(9);
  std::uniform_int_distribution<int> small(-3, 3);
  for (int trial = 0; trial < 2000; ++trial) {
    // Small offsets in units of 2^-50 about (1, 1, 1), for which the filter usually fails.
    long long m[3][3];
    Vec3d x[4];
    const Vec3d base = {{1, 1, 1}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        m[i][j] = small(random);
        x[i][j] = base[j] + static_cast<double>(m[i][j]) * 0x1p-50;
      }
    x[3] = base;
    const long long det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                          m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                          m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    ASSERT_EQ(orientation(x[0], x[1], x[2], x[3]), (det > 0) - (det < 0));
  }
}

}  // namespace
}  // namespace aspic
