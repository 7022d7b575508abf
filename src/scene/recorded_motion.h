// Motion of an obstacle that a point cache records.
#pragma once
#include "contact/contact_mesh.h"
#include "scene/placement.h"
#include "scene/value.h"

namespace aspic {

// Reads the `recording` of an obstacle, whose vertices it moves to their places at time 0. `place`: applied to all
// samples. Positions are interpolated linearly between samples and constant before and after. Throws InvalidInput.
ObstacleMotion recorded_motion(Value& obstacle, const AffineMap& place, SceneFiles& files, TriMesh& surface);

}  // namespace aspic
