// Depth of a point below the surface of a rigid indenter, where s and r are the components of x - c along and across
// the axis:
//   sphere: d = R - |x - c|
//   disc:   d = -m(|r| - R, s), where m(u, v) = v + w h((u - v) / w) is a maximum that is rounded, twice continuously
//           differentiable, over the width w of the rim; an arc of the radius 0.64 w has the same point of 45 degrees
#pragma once
#include "indenter/probe.h"

namespace aspic {

// Radius of an arc over the width w of the rounding, whose middle is as far from the corner, 3 sqrt(2) / 16 w.
inline constexpr double kArc = 0.64;
// Rim of a disc whose rim is not stated, and the limits of others, relative to the radius of the disc.
inline constexpr double kUsualRim = 0.1 * kArc, kSharpestRim = kUsualRim / 5, kRoundestRim = kArc;

// Radius of the rim of a disc [m], within these limits.
double rim_of(const Indenter& disc);

struct Depth {
  double value = 0;  // [m]; negative outside. 1-Lipschitz in x.
  Vec3d gradient{};  // [1]
  Mat3d hessian{};   // [1/m]
};

Depth depth(const Indenter& indenter, const IndenterPose& pose, const Vec3d& x);

// Derivatives of the depth and of its gradient by the logarithm of the rim of a disc.
struct RimChange {
  double value = 0;
  Vec3d gradient{};
};
RimChange rim_change(const Indenter& disc, const IndenterPose& pose, const Vec3d& x);

}  // namespace aspic
