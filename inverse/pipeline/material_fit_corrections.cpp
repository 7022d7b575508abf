// Corrections of the data that depend on the fit: systematic errors, and weights of a robust loss.
#include <algorithm>
#include <cmath>

#include "estimate/nuisance_estimates.h"
#include "model/systematic_errors.h"
#include "pipeline/material_fit.h"

namespace aspic {
namespace {

// Change of the logarithm of a layer stiffness or a rim per pass: estimates are linearized, and those far from the last
// diverge.
constexpr double kLargestStep = 1;

double change_of_weights(const std::vector<CaseWeights>& before, const std::vector<CaseWeights>& after) {
  double largest = 0;
  for (size_t c = 0; c < after.size(); ++c) {
    const auto compare = [&](double now, double then) { largest = std::max(largest, std::abs(now - then)); };
    for (size_t k = 0; k < after[c].positions.size(); ++k)
      compare(after[c].positions[k], before.empty() ? 1 : before[c].positions[k]);
    compare(after[c].force, before.empty() ? 1 : before[c].force);
    compare(after[c].torque, before.empty() ? 1 : before[c].torque);
  }
  return largest;
}

// The friction, layer stiffness or rim whose logarithm has the error.
std::optional<double> stated_coefficient(const Experiment& experiment, const SystematicError& error) {
  for (const LoadCase& load : experiment.cases) {
    if (!load.indenter || !concerns(error, load)) continue;
    if (error.kind == ErrorKind::friction) return load.indenter->friction;
    if (error.kind == ErrorKind::layer) return load.indenter->stiffness;
    if (error.kind == ErrorKind::rim) return load.indenter->rim;
  }
  return {};
}

}  // namespace

bool MaterialFit::has_corrections() const { return !data_.experiment.errors.empty() || plan_.robust; }

// The largest change of an error in standard deviations of its prior, or of a weight.
double MaterialFit::correct_data(FitModel& model, std::span<const double> p) {
  std::vector<double> r(static_cast<size_t>(model.misfit.residual_count()));
  if (!has_corrections() || !model.data().evaluate(p, r)) return 0;
  const std::vector<SystematicError>& errors = simulated_.errors();
  std::vector<double> values = model.with_layers->estimates(r);
  values.resize(errors.size());  // those of common errors follow
  for (size_t k = 0; k < values.size(); ++k)
    if (errors[k].kind == ErrorKind::layer || errors[k].kind == ErrorKind::rim)
      values[k] = std::clamp(values[k], errors[k].value - kLargestStep, errors[k].value + kLargestStep);
  double largest = 0;
  correction_steps_.resize(values.size(), 0.0);
  for (size_t k = 0; k < values.size(); ++k) {
    double step = values[k] - errors[k].value;
    largest = std::max(largest, std::abs(step) / errors[k].sigma);
    if (step * correction_steps_[k] < 0) step /= 2;  // alternates
    correction_steps_[k] = step;
    values[k] = errors[k].value + step;
  }
  std::vector<CaseWeights> weights;
  if (plan_.robust) {
    model.with_layers->errors().apply_transposed(r);
    weights = robust_weights(simulated_.fitted(), r, simulated_.weights());
    largest = std::max(largest, change_of_weights(simulated_.weights(), weights));
  }
  corrected_errors_ = values;
  corrected_weights_ = std::move(weights);
  return largest;
}

void MaterialFit::use_corrections() {
  if (has_corrections()) simulated_.correct(corrected_errors_, corrected_weights_);
}

void MaterialFit::list_errors(WithUncertainLayers& about_fit, std::span<const double> p) {
  Posterior* posterior = outcome_.posterior && outcome_.posterior->ok ? &*outcome_.posterior : nullptr;
  const std::vector<NuisanceEstimate> estimates =
      nuisance_estimates(about_fit, p, posterior ? posterior->gaussian.get() : nullptr);
  outcome_.errors.clear();
  for (size_t k = 0; k < std::min(estimates.size(), simulated_.errors().size()); ++k) {
    const SystematicError& error = simulated_.errors()[k];
    const double factor = posterior ? posterior->applied_factor : 1;
    const std::optional<double> stated = stated_coefficient(data_.experiment, error);
    const char* stated_unit = error.kind == ErrorKind::layer ? "Pa/m" : error.kind == ErrorKind::rim ? "m" : "";
    outcome_.errors.push_back({name_of(error), stated ? stated_unit : unit_of(error), estimates[k].value,
                               std::min(factor * estimates[k].sigma, error.sigma), error.sigma, stated});
  }
}

void MaterialFit::list_common_errors(const WithUncertainLayers& about_fit, std::span<const double> r) {
  outcome_.common_errors.clear();
  const std::vector<double> all = about_fit.estimates(r);
  const std::vector<CommonError>& errors = simulated_.fitted().cases.front().common_errors;
  for (size_t k = 0; k < errors.size() && simulated_.errors().size() + k < all.size(); ++k)
    outcome_.common_errors.push_back({errors[k].cause, all[simulated_.errors().size() + k]});
}

void MaterialFit::list_outliers() {
  outcome_.outliers.clear();
  const std::vector<LoadCase>& cases = simulated_.fitted().cases;
  const std::vector<CaseWeights>& weights = simulated_.weights();
  for (size_t c = 0; c < weights.size(); ++c) {
    const auto add = [&](double weight, const std::string& reading) {
      if (is_outlier(weight)) outcome_.outliers.push_back({cases[c].name, reading, weight});
    };
    for (size_t k = 0; k < weights[c].positions.size(); ++k)
      add(weights[c].positions[k], data_.marker_names[cases[c].positions[k].marker]);
    add(weights[c].force, "force");
    add(weights[c].torque, "torque");
  }
}

}  // namespace aspic
