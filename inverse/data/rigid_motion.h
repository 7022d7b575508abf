// Rigid motions and similarities of points.
#pragma once
#include <span>
#include <string>

#include "math/small.h"
#include "scene/placement.h"

namespace aspic {

struct AxisAngle {
  Vec3d axis = {{0, 0, 1}};  // unit vector
  double angle = 0;          // [rad], from 0 to pi
};
AxisAngle axis_angle_of(const Mat3d& rotation);

Vec3d centroid_of(std::span<const Vec3d> points);
Mat3d covariance_of(std::span<const Vec3d> points);  // mean of (x - centroid) (x - centroid)'
double spread_of(std::span<const Vec3d> points);     // root mean square distance from the centroid
// Returns the principal directions as columns with det = 1, the longest first; `variances` receives theirs.
Mat3d principal_axes(const Mat3d& covariance, Vec3d& variances);

// Returns the rotation, translation and, if requested, scale with the least sum of squared distances of the moved
// points from their targets [Umeyama 1991]. `second`: smaller singular value that fixes the rotation, over the largest.
AffineMap best_motion(std::span<const Vec3d> points, std::span<const Vec3d> targets, bool scales, double& second);

double scale_of(const AffineMap& map);    // of a similarity
Mat3d rotation_of(const AffineMap& map);  // of a similarity

}  // namespace aspic
