// Motion of pins and spring targets with a recorded surface.
#pragma once
#include <string>
#include <vector>

#include "dynamics/model.h"
#include "scene/placement.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic {

// Points that follow a surface, by their positions at rest and at time 0.
struct FollowingPoints {
  const std::vector<Vec3d>& rest;
  const std::vector<Vec3d>& starts;
  AffineMap place;  // of the body; applied to the surface and its recording
  std::string body, stem;
};

// Reads the surface and the point cache of a `recording` table and adds them to the results as `stem`. Each point keeps
// its offset from the closest point of the surface at rest, in the frame of the triangle there, so that it moves
// rigidly with a rigid motion of the surface. Throws InvalidInput.
Motion make_surface_motion(Table& recording, const FollowingPoints& points, SceneFiles& files);

}  // namespace aspic
