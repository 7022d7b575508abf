// Leave-one-group-out cross-validation: for each group of cases (an indentation), fits the material to the others and
// predicts the group.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "estimate/fit.h"
#include "model/misfit.h"

namespace aspic {

// Errors of readings of one kind: positions, forces or torques [m, N, N m].
struct ReadingErrors {
  int count = 0;     // number of readings
  double peak = 0;   // measured maximum; of positions: of the displacement of a marker
  double error = 0;  // root mean square of |predicted - measured|
  double noise = 0;  // expected part from the standard deviations alone

  double relative() const { return peak > 0 ? error / peak : 0; }
};

struct HeldOut {
  std::string group;
  bool ok = false;
  std::string failure;  // why there is no prediction
  ReadingErrors positions, forces, torques;
  double largest_error = 0;  // of the positions [m]
  std::vector<double> p;     // fitted without the group
};

struct CrossValidation {
  std::vector<HeldOut> groups;  // in the order of the cases
  // Root mean square over the predicted groups, relative to the peak of each; < 0: none.
  double position_error = -1, force_error = -1, torque_error = -1;
  std::vector<std::string> warnings;
};

std::vector<std::string> groups_of(const Experiment& experiment);  // in order of appearance

// Returns the equilibria of these cases among those of all cases, which are one after another; see Misfit::state().
std::vector<double> subset(const Experiment& experiment, std::span<const double> state,
                           const std::function<bool(const LoadCase&)>& wanted);

// Compares predictions for the cases of `left_out`, in order, with the measurements.
HeldOut compare(const Experiment& left_out, std::span<const CasePrediction> predicted);

// Called before each group is held out.
using CrossValidationObserver = std::function<void(int group, int groups, const std::string& name)>;

// Returns the result of a group, stored or by `compute`; empty: the group is left out of the result.
using HeldOutStore =
    std::function<std::optional<HeldOut>(int group, const std::string& name, const std::function<HeldOut()>& compute)>;

struct CrossValidationOptions {
  FitOptions fit = {};
  EquilibriumOptions equilibrium = {};
  CrossValidationObserver observe = {};
  const Corrected* to_predict = nullptr;  // cases for comparisons with predictions; null: those that are fitted
  HeldOutStore store = {};                // none: everything is computed
  std::vector<double> start = {};         // state of a Misfit of all cases near the fit; empty: none
};

// `fitted`: fit of all cases; its p is the initial guess and its weight is kept.
CrossValidation cross_validate(const Corrected& experiment, const ParameterMap& map, Regularizer& regularizer,
                               const FitReport& fitted, const CrossValidationOptions& options = {});

}  // namespace aspic
