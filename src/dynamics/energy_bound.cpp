#include "dynamics/energy_bound.h"

#include <algorithm>
#include <cmath>

#include "dynamics/step_report.h"

namespace aspic {
namespace {

// Relative round-off of a sum of a million terms of equal size with random rounding errors: a thousand units in the
// last place.
constexpr double kSumRoundOff = 1e-12;

}  // namespace

// In the order of EnergyBound.
constexpr std::string_view kEnergyBoundNames[] = {"none", "not_guaranteed", "holds", "broken"};

std::string_view to_string(EnergyBound bound) { return kEnergyBoundNames[static_cast<size_t>(bound)]; }

EnergyBound energy_bound(const BoundedEnergies& energies, double accepted) {
  const double round_off = kSumRoundOff * energies.magnitude + energies.round_off;
  if (!std::isfinite(energies.allowed) || !(accepted <= energies.allowed + round_off))
    return EnergyBound::not_guaranteed;
  return energies.reached <= energies.allowed + 2 * round_off ? EnergyBound::holds : EnergyBound::broken;
}

void check_energy_bound(const BoundedEnergies& bounded, double accepted, StepReport& report) {
  const EnergyBound verdict = energy_bound(bounded, accepted);
  const double slack = bounded.allowed - bounded.reached;
  const bool is_first = report.energy_bound == EnergyBound::none;
  report.energy_slack = is_first ? slack : std::min(report.energy_slack, slack);
  if (is_first || verdict == EnergyBound::broken ||
      (verdict == EnergyBound::not_guaranteed && report.energy_bound == EnergyBound::holds))
    report.energy_bound = verdict;
}

}  // namespace aspic
