// Leave-one-group-out cross-validation: for each group of cases (an indentation), fits the material to the others and
// predicts the group.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fit/fit.h"
#include "fit/misfit.h"

namespace aspic {

struct HeldOut {
  std::string group;
  bool ok = false;
  std::string failure;  // why there is no prediction
  int readings = 0;     // number of marker readings in the group
  int forces = 0;
  double peak_motion = 0;                   // measured maximum displacement of a marker [m]
  double position_error = 0;                // root mean square of |predicted - measured| [m]
  double largest_error = 0;                 // [m]
  double position_noise = 0;                // expected part from the standard deviations alone [m]
  double peak_force = 0;                    // measured maximum [N]
  double force_error = 0, force_noise = 0;  // the same for forces [N]
  std::vector<double> p;                    // fitted without the group

  double relative_position_error() const { return peak_motion > 0 ? position_error / peak_motion : 0; }
  double relative_force_error() const { return peak_force > 0 ? force_error / peak_force : 0; }
};

struct CrossValidation {
  std::vector<HeldOut> groups;  // in the order of the cases
  // Root mean square over the predicted groups, relative to the peak of each; < 0: none.
  double position_error = -1, force_error = -1;
  std::vector<std::string> warnings;
};

// Returns the cases for which `wanted` is true, with the same body.
Experiment subset(const Experiment& experiment, const std::function<bool(const LoadCase&)>& wanted);

// Compares predictions for the cases of `left_out`, in order, with the measurements.
HeldOut compare(const Experiment& left_out, std::span<const CasePrediction> predicted);

// Called before each group is held out.
using CrossValidationObserver = std::function<void(int group, int groups, const std::string& name)>;

struct CrossValidationOptions {
  FitOptions fit = {};
  EquilibriumOptions equilibrium = {};
  CrossValidationObserver observe = {};
  const Experiment* to_predict = nullptr;  // cases for comparisons with predictions; null: those that are fitted
};

// `fitted`: fit of all cases; its p is the initial guess and its weight is kept.
CrossValidation cross_validate(const Experiment& experiment, const ParameterMap& map, Regularizer& regularizer,
                               const FitReport& fitted, const CrossValidationOptions& options = {});

}  // namespace aspic
