// How deep a point lies below the surface of a rigid tip.
//   sphere: d = R - |x - c|
//   disc:   d = -m(|r| - R, s), with s and r the parts of x - c along and across the axis and m a maximum that is
//           rounded, twice continuously differentiable, over the width of the rim: m(u, v) = v + w h((u - v) / w)
#pragma once
#include "energy/probe.h"

namespace aspic {

inline constexpr double kRim = 0.1;  // width of the rounded rim of a disc, relative to its radius

struct Depth {
  double value = 0;  // [m]; negative outside. Never changes faster than the point moves.
  Vec3d gradient{};  // [1]
  Mat3d hessian{};   // [1/m]
};

Depth depth(const Tip& tip, const TipPose& pose, const Vec3d& x);

}  // namespace aspic
