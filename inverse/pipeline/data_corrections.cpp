// Corrections of the data that depend on the fit: systematic errors, and weights of a robust loss.
#include <algorithm>
#include <cmath>

#include "estimate/nuisance_estimates.h"
#include "model/limits.h"
#include "model/systematic_errors.h"
#include "pipeline/data_corrections.h"

namespace aspic {
namespace {

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
std::optional<double> stated_coefficient(const Measured& experiment, const SystematicError& error) {
  for (const LoadCase& load : experiment.cases) {
    if (!load.indenter || !concerns(error, load)) continue;
    if (error.kind == ErrorKind::friction) return load.indenter->friction;
    if (error.kind == ErrorKind::layer) return load.indenter->stiffness;
    if (error.kind == ErrorKind::rim) return load.indenter->rim;
  }
  return {};
}

}  // namespace

double DataCorrections::estimate(FitModel& model, std::span<const double> p, const SimulatedData& simulated,
                                 bool is_robust) {
  std::vector<double> r(static_cast<size_t>(model.misfit.residual_count()));
  if (!model.data().evaluate(p, r)) return 0;
  const std::vector<SystematicError>& errors = simulated.simulated().errors;
  std::vector<double> values = model.with_layers->estimates(r);
  values.resize(errors.size());  // those of common errors follow
  for (size_t k = 0; k < values.size(); ++k)
    // Logarithms: estimates are linearized, and those far from the last diverge.
    if (errors[k].kind == ErrorKind::layer || errors[k].kind == ErrorKind::rim)
      values[k] = std::clamp(values[k], errors[k].value - kLinearRange, errors[k].value + kLinearRange);
  double largest = 0;
  steps_.resize(values.size(), 0.0);
  for (size_t k = 0; k < values.size(); ++k) {
    double step = values[k] - errors[k].value;
    largest = std::max(largest, std::abs(step) / errors[k].sigma);
    if (step * steps_[k] < 0) step /= 2;  // alternates
    steps_[k] = step;
    values[k] = errors[k].value + step;
  }
  std::vector<CaseWeights> weights;
  if (is_robust) {
    model.with_layers->errors().apply_transposed(r);
    weights = robust_weights(simulated.fitted(), r, simulated.weights());
    largest = std::max(largest, change_of_weights(simulated.weights(), weights));
  }
  errors_ = values;
  weights_ = std::move(weights);
  return largest;
}

std::vector<EstimatedError> estimated_errors(WithUncertainLayers& about_fit, std::span<const double> p,
                                             const SimulatedData& simulated, const Measured& measured,
                                             const Posterior* posterior) {
  const std::vector<NuisanceEstimate> estimates =
      nuisance_estimates(about_fit, p, posterior ? posterior->gaussian.get() : nullptr);
  std::vector<EstimatedError> all;
  for (size_t k = 0; k < std::min(estimates.size(), simulated.simulated().errors.size()); ++k) {
    const SystematicError& error = simulated.simulated().errors[k];
    const double factor = posterior ? posterior->applied_factor : 1;
    const std::optional<double> stated = stated_coefficient(measured, error);
    const char* stated_unit = error.kind == ErrorKind::layer ? "Pa/m" : error.kind == ErrorKind::rim ? "m" : "";
    all.push_back({name_of(error), stated ? stated_unit : unit_of(error), estimates[k].value,
                   std::min(factor * estimates[k].sigma, error.sigma), error.sigma, stated});
  }
  return all;
}

std::vector<FoundCommonError> common_errors(const SimulatedData& simulated, const WithUncertainLayers& about_fit,
                                            std::span<const double> r) {
  std::vector<FoundCommonError> found;
  const std::vector<double> all = about_fit.estimates(r);
  const std::vector<CommonError>& errors = simulated.fitted().cases.front().common_errors;
  for (size_t k = 0; k < errors.size() && simulated.simulated().errors.size() + k < all.size(); ++k)
    found.push_back({errors[k].cause, all[simulated.simulated().errors.size() + k]});
  return found;
}

std::vector<Outlier> outliers(const SimulatedData& simulated, const DataSet& data) {
  std::vector<Outlier> found;
  const std::vector<LoadCase>& cases = simulated.fitted().cases;
  const std::vector<CaseWeights>& weights = simulated.weights();
  for (size_t c = 0; c < weights.size(); ++c) {
    const auto add = [&](double weight, const std::string& reading) {
      if (is_outlier(weight)) found.push_back({cases[c].name, reading, weight});
    };
    for (size_t k = 0; k < weights[c].positions.size(); ++k)
      add(weights[c].positions[k], data.marker_names[cases[c].positions[k].marker]);
    add(weights[c].force, "force");
    add(weights[c].torque, "torque");
  }
  return found;
}

}  // namespace aspic
