// Directions near a reference direction by two coordinates in its tangent plane, without a pole: the gnomonic map
//   a(u, v) = b / |b|,  b = c + u t1 + v t2,  for orthonormal c, t1, t2.
// The sign of a is irrelevant. At u = v = 0 the coordinates are angles in radians.
#pragma once
#include <cmath>

#include "math/small.h"

namespace aspic {

class TangentFrame {
 public:
  // Requires |center| > 0.
  explicit TangentFrame(const Vec3d& center) : center_((1 / norm(center)) * center) {
    int least = 0;
    for (int r = 1; r < 3; ++r)
      if (std::abs(center_[r]) < std::abs(center_[least])) least = r;
    Vec3d axis{};
    axis[least] = 1;
    const Vec3d across = cross(center_, axis);
    tangent_[0] = (1 / norm(across)) * across;
    tangent_[1] = cross(center_, tangent_[0]);
  }

  Vec3d direction(double u, double v) const {
    const Vec3d b = toward(u, v);
    return (1 / norm(b)) * b;
  }
  // da/du (k = 0) or da/dv (k = 1).
  Vec3d slope(int k, double u, double v) const {
    const Vec3d b = toward(u, v);
    const double length = norm(b);
    const Vec3d a = (1 / length) * b;
    return (1 / length) * (tangent_[k] - dot(a, tangent_[k]) * a);
  }

 private:
  Vec3d toward(double u, double v) const { return center_ + u * tangent_[0] + v * tangent_[1]; }

  Vec3d center_, tangent_[2];
};

}  // namespace aspic
