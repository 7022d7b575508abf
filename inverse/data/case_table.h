// Table of load cases.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "data/data_set.h"
#include "data/force_series.h"
#include "data/settings.h"
#include "data/stated_errors.h"
#include "data/surface_projection.h"

namespace aspic {

struct CaseScope {
  const std::map<std::string, Indenter>& indenters;
  const std::map<std::string, TipSigmas>& tip_sigmas;  // of each indenter
  const std::map<std::string, Grip>& grips;            // without motion
  const std::map<std::string, std::vector<Triangle>>& patches;
  const SurfaceProjection& surface;
  const ForceSeries* forces = nullptr;  // of cases without a force of their own
};

// Appends the cases group by group, each from the smallest load on, and their lines.
void read_cases(const CaptureSettings& settings, const CaseScope& scope, ErrorList& errors, DataSet& data);

// Size of the load of a case: displacement of the indenter or of the vertices of the grip [m], pressure [Pa] or gravity
// [m/s^2].
double load_size(const LoadCase& load);

// Standard deviation of the force along its direction, or along that of a single-axis gauge [N].
double sigma_along(const LoadCase& load);

// Axis of an indenter that has rotated since the touch.
Vec3d turned_axis(const IndenterPose& touch, const Vec3d& rotation);

}  // namespace aspic
