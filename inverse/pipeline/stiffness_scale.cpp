#include "pipeline/stiffness_scale.h"

#include <algorithm>
#include <cmath>

#include "math/vectors.h"
#include "model/quantity.h"
#include "pipeline/fit_stages.h"

namespace aspic {

bool StiffnessScale::relate(const Experiment& ends, double log_factor) {
  FitOutcome& outcome = state_.outcome;
  const std::vector<FitParameter>& fitted = state_.model->map.fitted_parameters();
  const bool has_several = std::any_of(fitted.begin(), fitted.end(), [](const FitParameter& u) {
    return is_stiffness(u.quantity) && u.parameterization != Parameterization::uniform;
  });
  const Posterior* posterior = outcome.known_posterior();
  if (!has_several || !posterior || !posterior->gaussian || outcome.parts) return false;
  const std::vector<double> p = with_factor(log_factor);
  std::optional<StiffnessChange> change = aspic::stiffness_change(ends, {state_.model->map, state_.mesh(), p},
                                                                  *posterior->gaussian, state_.plan.equilibrium);
  if (!change) {
    outcome.warnings.push_back("the last states of the histories have no derivatives with respect to the stiffness: " +
                               std::string(change_ ? "its intervals may be too narrow"
                                                   : "the histories multiply all its values by one factor"));
    return false;
  }
  if (change_ && !change->differs_from(*change_)) return false;
  change_ = std::move(change);
  return true;
}

std::vector<MaterialParameters> StiffnessScale::material_at(double log_factor) const {
  return state_.model->map.parameters(with_factor(log_factor));
}

std::vector<double> StiffnessScale::with_factor(double log_factor) const {
  std::vector<double> p = state_.p;
  if (change_) {
    add_scaled(log_factor, change_->p, p);
    return p;
  }
  for (size_t u = 0; u < state_.model->map.fitted_parameters().size(); ++u) {
    if (!is_stiffness(state_.model->map.fitted_parameters()[u].quantity)) continue;
    const auto [first, count] = state_.model->map.range(static_cast<int>(u));
    for (int k = first; k < first + count; ++k) p[static_cast<size_t>(k)] += log_factor;
  }
  return p;
}

bool StiffnessScale::multiply(double factor, double sigma) {
  FitOutcome& outcome = state_.outcome;
  const std::vector<std::string> warnings = outcome.warnings;
  const std::vector<double> p = with_factor(std::log(factor));
  if (change_) narrow(*change_, state_.model->map, sigma, *outcome.posterior);
  for (CaseOutcome& c : outcome.cases) c.ok = false;
  if (outcome.parts) {
    for (double& value : outcome.parts->values) value *= factor;
    for (Interval& interval : outcome.parts->intervals) interval.lower *= factor, interval.upper *= factor;
  }
  describe(state_, *state_.model, p);
  predict_left_out(state_);
  outcome.warnings = warnings;
  return std::all_of(outcome.cases.begin(), outcome.cases.end(), [](const CaseOutcome& c) { return c.ok; });
}

}  // namespace aspic
