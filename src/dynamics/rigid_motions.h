// Rigid motions that neither pins nor loads resist. In statics, the only stiffness along them is from stresses and
// follower loads.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "dynamics/model.h"

namespace aspic {

struct RigidMotion {
  int body = 0;   // index of Model::bodies
  Vec3d along{};  // unit direction
  bool is_rotation = false;
  Vec3d point{};  // on the axis of a rotation [m]
};

// Returns a free motion of the first body that has one, preferably a translation. `x`: positions, for example the
// initial ones, because those of a failed solve may be unusable.
std::optional<RigidMotion> free_rigid_motion(const Model& model, std::span<const double> x);

// "slide along (1, 0, 0)", "rotate about the axis through (0, 0.5, 0) m along (0, 0, 1)".
std::string to_string(const RigidMotion& motion);

}  // namespace aspic
