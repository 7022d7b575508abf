// Depth of a point below the surface of a rigid indenter, where s and r are the components of x - c along and across
// the axis:
//   sphere: d = R - |x - c|
//   disc:   d = -m(|r| - R, s), where m(u, v) = v + w h((u - v) / w) is a maximum that is rounded, twice continuously
//           differentiable, over the width w of the rim
#pragma once
#include "energy/probe.h"

namespace aspic {

inline constexpr double kRim = 0.1;  // width of the rounded rim of a disc, relative to its radius

struct Depth {
  double value = 0;  // [m]; negative outside. 1-Lipschitz in x.
  Vec3d gradient{};  // [1]
  Mat3d hessian{};   // [1/m]
};

Depth depth(const Indenter& indenter, const IndenterPose& pose, const Vec3d& x);

}  // namespace aspic
