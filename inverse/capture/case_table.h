// The table of load cases.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "capture/data_set.h"
#include "capture/settings.h"
#include "capture/surface_projection.h"

namespace aspic {

struct CaseScope {
  const std::map<std::string, Tip>& tips;
  const std::map<std::string, std::vector<Triangle>>& patches;
  const SurfaceProjection& surface;
};

// Appends the cases, of a group one after another, from the smallest load on, and their lines.
void read_cases(const CaptureSettings& settings, const CaseScope& scope, ErrorList& errors, DataSet& data);

// How far the load of a case goes: the way of the tip [m], the pressure [Pa] or the gravity [m/s^2].
double load_size(const LoadCase& load);

// Standard deviation of the force along itself [N]. Not counted is how open a gauge of one axis leaves the force
// across.
double deviation_along(const LoadCase& load);

// The axis of a tip that has turned since the touch.
Vec3d turned_axis(const TipPose& touch, const Vec3d& rotation);

}  // namespace aspic
