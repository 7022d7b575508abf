// Gravity of the scan of a mesh.
#pragma once
#include "data/settings.h"
#include "math/small.h"

namespace aspic {

// Acceleration [m/s^2]. Throws InvalidInput if the data have grips or bonded tips, which attach to the unloaded mesh.
Vec3d read_scan_gravity(const CaptureSettings& settings, const Value& gravity);

}  // namespace aspic
