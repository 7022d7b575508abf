#include "indenter/indenter_depth.h"

#include <algorithm>

namespace aspic {
namespace {

// Length and direction. The direction is zero at the origin, where that of a point inside an indenter is irrelevant.
struct Polar {
  double length;
  Vec3d direction;
};
Polar polar(const Vec3d& v) {
  const double length = norm(v);
  return {length, length > 0 ? (1 / length) * v : Vec3d{}};
}

Depth depth_in_sphere(double radius, const Vec3d& u) {
  const auto [length, n] = polar(u);
  const double curvature = length > 0 ? 1 / length : 0;
  return {radius - length, -1.0 * n, curvature * (outer(n, n) - identity3<double>())};
}

// h(t) = 0 for t < -1, t for t > 1, with h'' = 3/4 (1 - t^2) in between.
struct Rounding {
  double value, slope, curvature;
};
Rounding rounding(double t) {
  if (t <= -1) return {0, 0, 0};
  if (t >= 1) return {t, 1, 0};
  const double tt = t * t;
  return {t / 2 + 3.0 / 8 * tt - tt * tt / 16 + 3.0 / 16, 0.5 + 0.75 * t * (1 - tt / 3), 0.75 * (1 - tt)};
}

// A point near a disc: its coordinates, the width of the rim, and its place across the rim.
struct DiscPoint {
  DiscPoint(const Indenter& disc, const Vec3d& axis, const Vec3d& x)
      : s(dot(x, axis)), width(rim_of(disc) / kArc), across(polar(x - s * axis)) {
    t = (across.length - disc.radius - s) / width;
  }
  double s, width;
  Polar across;
  double t;
};

Depth depth_in_disc(const Indenter& disc, const Vec3d& axis, const Vec3d& x) {
  const DiscPoint point(disc, axis, x);
  const auto& [r, e] = point.across;
  const double s = point.s, width = point.width;
  const Rounding h = rounding(point.t);
  const Vec3d across = e - axis;
  const Mat3d turning = r > 0 ? (1 / r) * (identity3<double>() - outer(axis, axis) - outer(e, e)) : Mat3d{};
  return {-(s + width * h.value), (h.slope - 1) * axis - h.slope * e,
          (-h.curvature / width) * outer(across, across) - h.slope * turning};
}

}  // namespace

Depth depth(const Indenter& indenter, const IndenterPose& pose, const Vec3d& x) {
  return indenter.shape == IndenterShape::sphere ? depth_in_sphere(indenter.radius, x - pose.center)
                                                 : depth_in_disc(indenter, pose.axis, x - pose.center);
}

double rim_of(const Indenter& disc) {
  const double rim = disc.rim > 0 ? disc.rim / disc.radius : kUsualRim;
  return std::clamp(rim, kSharpestRim, kRoundestRim) * disc.radius;
}

// With the width w, dt/dlog w = -t.
RimChange rim_change(const Indenter& disc, const IndenterPose& pose, const Vec3d& x) {
  const DiscPoint point(disc, pose.axis, x - pose.center);
  const Rounding h = rounding(point.t);
  return {-point.width * (h.value - point.t * h.slope), (point.t * h.curvature) * (point.across.direction - pose.axis)};
}

}  // namespace aspic
