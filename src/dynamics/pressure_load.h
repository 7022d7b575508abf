// Follower pressures on patches of the boundary: p against the normals of the current shape, per current area.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/model.h"
#include "mesh/surface.h"

namespace aspic {

struct PressureLoad {
  std::string name;                          // in reports
  std::vector<Face> patch;                   // boundary faces of the model's mesh
  std::function<double(double time)> value;  // [Pa], positive inward
  bool starts_at_rest = true;                // whether the rim of the patch starts in its rest shape
};

// A pressure on a closed patch, or on one whose rim is fixed, has the potential p W (see energy/pressure.h). On other
// patches the share of the rim is lagged within the step (see energy/pressure_rim.h).
enum class PressureForm { closed, fixed_rim, open };
std::string_view to_string(PressureForm form);

// Adds the terms of a pressure to a model that has its pins. Returns their form.
PressureForm add_pressure(const PressureLoad& load, Model& model);

}  // namespace aspic
