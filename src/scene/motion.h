// Prescribed motions of pins and of the targets of springs.
#pragma once
#include <vector>

#include "dynamics/model.h"
#include "scene/value.h"

namespace aspic {

// Returns the motion, empty for "fixed". `starts`: positions at time 0, whose mean is the default center of a rotation.
Motion make_motion(const Value& motion, const std::vector<Vec3d>& starts);

}  // namespace aspic
