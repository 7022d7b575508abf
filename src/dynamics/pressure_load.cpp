#include "dynamics/pressure_load.h"

#include <algorithm>

#include "dynamics/pins.h"
#include "dynamics/state.h"
#include "energy/pressure.h"
#include "energy/pressure_rim.h"

namespace aspic {
namespace {

bool is_fixed(const std::vector<RimEdge>& rim, const Model& model) {
  std::vector<Pin> fixed = model.pins;
  std::erase_if(fixed, [](const Pin& pin) { return pin.motion != nullptr; });
  const Pins pins(fixed, at_rest(model.mesh).q);
  return std::all_of(rim.begin(), rim.end(), [&](const RimEdge& edge) {
    return pins.holds(edge.a) && pins.holds(edge.b) && (edge.mid < 0 || pins.holds(edge.mid));
  });
}

}  // namespace

std::string_view to_string(PressureForm form) {
  constexpr std::string_view kForms[] = {"closed surface: has a potential", "fixed rim: has a potential",
                                         "open patch: without a potential, its rim is updated within each step"};
  return kForms[static_cast<size_t>(form)];
}

PressureForm add_pressure(const PressureLoad& load, Model& model) {
  model.loads.push_back(make_pressure(load.name, model.mesh, load.patch, load.value));
  const std::vector<RimEdge> rim = rim_of(load.patch);
  if (rim.empty()) return PressureForm::closed;
  if (load.starts_at_rest && is_fixed(rim, model)) return PressureForm::fixed_rim;
  model.damping.push_back(make_pressure_rim(*model.loads.back(), model.mesh, rim, load.value));
  return PressureForm::open;
}

}  // namespace aspic
