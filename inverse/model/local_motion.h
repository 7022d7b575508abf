// Motion of a marker as expected from its neighbors, to find outliers.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "math/small.h"

namespace aspic {

inline constexpr int kMotionNeighbors = 12;  // three times the coefficients of the field; even, for a median
using MotionNeighbors = std::array<int, kMotionNeighbors>;  // indices by ascending distance

// Returns the nearest other points of each point, by ascending distance and index. Requires more than kMotionNeighbors
// points with finite coordinates. Takes O(n log n) for any distribution of the points.
std::vector<MotionNeighbors> nearest_points(std::span<const Vec3d> points);

struct ExpectedMotion {
  Vec3d u{};          // motion of the point predicted from its neighbors
  double spread = 0;  // median difference between the neighbors and such a field
  double range = 0;   // median difference between the neighbors and the expected motion of the point
};

// Motion of point i of X. Fits the field u = c + B (X - X_i) / reach with the least sum of |u_j - u| over the
// neighbors, by reweighted least squares, which downweights outliers among the neighbors.
ExpectedMotion expected_motion(std::span<const Vec3d> X, std::span<const Vec3d> u, int i, const MotionNeighbors& near);

}  // namespace aspic
