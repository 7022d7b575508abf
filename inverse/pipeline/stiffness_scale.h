// The stiffness of a fitted material as one number, which histories determine after the fit of static cases.
#pragma once
#include <optional>
#include <vector>

#include "pipeline/fit_state.h"
#include "pipeline/stiffness_change.h"

namespace aspic {

class StiffnessScale {
 public:
  explicit StiffnessScale(FitState& state) : state_(state) {}  // stores a reference

  // Several stiffnesses with a posterior change as StiffnessChange describes, otherwise by a common factor. Linearizes
  // at the factor and returns whether this makes a difference. `ends`: last states of histories.
  bool relate(const Experiment& ends, double log_factor);
  const std::optional<StiffnessChange>& change() const { return change_; }
  std::vector<MaterialParameters> material_at(double log_factor) const;
  // Multiplies the fitted stiffness by a factor: values, material and predictions. Returns false without an
  // equilibrium. `sigma`: standard deviation of its logarithm.
  bool multiply(double factor, double sigma);

 private:
  std::vector<double> with_factor(double log_factor) const;  // parameters

  FitState& state_;
  std::optional<StiffnessChange> change_;
};

}  // namespace aspic
