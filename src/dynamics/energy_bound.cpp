#include "dynamics/energy_bound.h"

#include <cmath>

namespace aspic {
namespace {

// Sums of a million terms of one size, rounded at random, err by a thousand units in the last place.
constexpr double kRoundOff = 1e-12;

}  // namespace

std::string_view to_string(EnergyBound bound) {
  switch (bound) {
    case EnergyBound::none:
      return "none";
    case EnergyBound::not_guaranteed:
      return "not_guaranteed";
    case EnergyBound::holds:
      return "holds";
    case EnergyBound::broken:
      return "broken";
  }
  return "unknown";
}

EnergyBound energy_bound(const BoundedEnergies& energies, double accepted) {
  const double noise = kRoundOff * energies.magnitude + energies.round_off;
  if (!std::isfinite(energies.allowed) || !(accepted <= energies.allowed + noise)) return EnergyBound::not_guaranteed;
  return energies.reached <= energies.allowed + 2 * noise ? EnergyBound::holds : EnergyBound::broken;
}

}  // namespace aspic
