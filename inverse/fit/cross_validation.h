// Leave-one-group-out cross-validation: each group of cases (a poke) is left out in turn, the material is
// fitted to the others, and the group is predicted.
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
  int readings = 0;     // of markers, over all cases of the group
  int forces = 0;
  double peak_motion = 0;                   // of a marker from its place at rest, as measured [m]
  double position_error = 0;                // root mean square of |predicted - measured| [m]
  double largest_error = 0;                 // [m]
  double position_noise = 0;                // what the standard deviations alone would leave of it [m]
  double peak_force = 0;                    // as measured [N]
  double force_error = 0, force_noise = 0;  // the same of forces [N]
  std::vector<double> p;                    // fitted without the group

  double relative_position_error() const { return peak_motion > 0 ? position_error / peak_motion : 0; }
  double relative_force_error() const { return peak_force > 0 ? force_error / peak_force : 0; }
};

struct CrossValidation {
  std::vector<HeldOut> groups;  // in the order of the cases
  // Root mean square over the groups that were predicted, relative to the peak of each; < 0: there is none.
  double position_error = -1, force_error = -1;
  std::vector<std::string> warnings;
};

// The cases for which `wanted` is true, of the same body.
Experiment subset(const Experiment& experiment, const std::function<bool(const LoadCase&)>& wanted);

// What was predicted for the cases of `left_out`, one after another, against what was measured.
HeldOut compare(const Experiment& left_out, std::span<const CasePrediction> predicted);

// Called before each group is left out.
using CrossValidationObserver = std::function<void(int group, int groups, const std::string& name)>;

// `fitted`: of all cases; its p is the start and its weight is kept.
CrossValidation cross_validate(const Experiment& experiment, const ParameterMap& map, Regularizer& regularizer,
                               const FitReport& fitted, FitOptions options = {},
                               const EquilibriumOptions& equilibrium = {}, const CrossValidationObserver& observe = {});

}  // namespace aspic
