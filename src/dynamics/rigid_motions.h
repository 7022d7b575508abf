// The rigid motions of bodies that neither pins nor loads resist. Along them statics have no stiffness, or only that of
// stresses and of loads that turn with the body.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "dynamics/model.h"

namespace aspic {

struct RigidMotion {
  int body = 0;   // index of Model::bodies
  Vec3d along{};  // its direction, of length 1
  bool is_rotation = false;
  Vec3d point{};  // on the axis of a rotation [m]
};

// Returns one of the first body that has any, a translation rather than a rotation; else none. `x`: positions, such as
// those at the start: those of a solve that failed may be far from them.
std::optional<RigidMotion> free_rigid_motion(const Model& model, std::span<const double> x);

// "slide along (1, 0, 0)", "rotate about the axis through (0, 0.5, 0) m along (0, 0, 1)".
std::string to_string(const RigidMotion& motion);

}  // namespace aspic
