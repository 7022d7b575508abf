#include <algorithm>
#include <cmath>

#include "math/vectors.h"
#include "model/gauge.h"
#include "model/quantity.h"
#include "pipeline/fit_troubles.h"
#include "pipeline/fitted_values.h"
#include "pipeline/material_fit.h"

namespace aspic {
namespace {

constexpr double kLearnt = 1;  // number of determined directions below which the data are uninformative

// Prediction for residuals r at the estimated systematic errors and layer stiffness.
void put_layers_in(std::span<const double> r, const LoadCase& fitted, CasePrediction& shown) {
  auto residual = r.begin();
  const auto put = [&](const Vec3d& reading, const Vec3d& sigma, Vec3d& to) {
    for (int i = 0; i < 3; ++i) to[i] = reading[i] + *residual++ * sigma[i];
  };
  for (size_t k = 0; k < fitted.positions.size(); ++k)
    put(fitted.positions[k].position, fitted.positions[k].sigma, shown.markers[k]);
  // Predictions across a gauge stay as they are.
  const auto put_along = [&](const std::optional<Vec3d>& gauge, const Vec3d& reading, const Vec3d& sigma, Vec3d& to) {
    if (!gauge) return put(reading, sigma, to);
    const double along = dot(*gauge, reading) + *residual * gauge_sigma(gauge, sigma)[0];
    to = to + (along - dot(*gauge, to)) * *gauge;
    residual += 3;
  };
  if (fitted.force) put_along(fitted.gauge, *fitted.force, fitted.force_sigma, shown.wrench.force);
  if (fitted.torque) put_along(fitted.torque_gauge, *fitted.torque, fitted.torque_sigma, shown.wrench.torque);
}

}  // namespace

void MaterialFit::learn_uncertainty(FitModel& model) {
  if (!plan_.uncertainty || is_stopped()) return;
  begin(FitStage::uncertainty, has_many_values() ? "standard deviation of every tet" : "standard deviations");
  const FitReport& report = outcome_.report;
  WithUncertainLayers about_fit(model.recorded());
  outcome_.posterior = posterior(about_fit, *model.prior, report.weight, {model.map, mesh(), report.p});
  // If the initial guess already explains the data, weight rules raise the weight, and the prior would look like data.
  const bool is_learnt = !outcome_.posterior->ok || outcome_.posterior->informed >= kLearnt;
  if (!is_learnt && plan_.fit.weight <= 0 && report.weight > 1) {
    outcome_.posterior = posterior(about_fit, *model.prior, 1, {model.map, mesh(), report.p});
    std::erase(outcome_.posterior->warnings, outcome_.posterior->weight_warning);
    add_warnings(
        {"the data hardly determine how the stiffness varies: the standard deviations are those of the "
         "prior (--unknown young=uniform fits one value)"});
  }
  // For a few values the prior is weak by intention.
  if (!has_many_values()) std::erase(outcome_.posterior->warnings, outcome_.posterior->weight_warning);
  list_errors(about_fit, report.p);
  add_warnings(outcome_.posterior->warnings);
}

// Stores the material of p, its values for display, and predictions for the fitted cases.
void MaterialFit::describe(FitModel& model, std::span<const double> p) {
  const Posterior* posterior = outcome_.posterior && outcome_.posterior->ok ? &*outcome_.posterior : nullptr;
  outcome_.quantities = fitted_quantities(model.map, mesh(), p, posterior);
  if (outcome_.parts && outcome_.parts->are_kept) show_parts(*outcome_.parts, outcome_.quantities);
  outcome_.material = fitted_material(data_, model.map, p, outcome_.quantities);
  describe_fibres(model.map, p);
  outcome_.at_bound = values_at_bound(model.map, p);
  outcome_.counts = model.misfit.counts();
  outcome_.cases.resize(data_.experiment.cases.size());
  described_.assign(p.begin(), p.end());
  if (model.journal) model.journal->catch_up();
  Misfit& misfit = model.of_all_readings();
  std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
  WithUncertainLayers about_fit(misfit);
  const bool ok = about_fit.evaluate(p, r);
  if (ok) {
    outcome_.report.misfit = dot(r, r) / 2;
    if (const std::string worst = describe_worst_row(data_, plan_.left_out, misfit, r); !worst.empty())
      add_warnings({worst});
    list_common_errors(about_fit, r);
    about_fit.errors().apply_transposed(r);
  }
  list_outliers();
  int fitted = 0;
  for (size_t c = 0; c < outcome_.cases.size(); ++c) {
    CaseOutcome& outcome = outcome_.cases[c];
    outcome.left_out = is_left_out(plan_.left_out, data_.experiment.cases[c]);
    if (outcome.left_out) continue;
    const auto [first, count] = misfit.residuals_of(fitted);
    const LoadCase& load = simulated_.fitted().cases[fitted];
    CasePrediction prediction = misfit.prediction(fitted++);
    if (!ok) continue;
    put_layers_in(std::span(r).subspan(first, count), load, prediction);
    outcome.markers_on_mesh = prediction.markers;
    outcome.wrench_on_mesh = prediction.wrench;
    prediction = simulated_.as_read_on_finer_mesh(c, prediction);
    outcome.ok = true;
    outcome.markers = std::move(prediction.markers);
    outcome.wrench = prediction.wrench;
    outcome.marker_sigma.clear();
    for (const MarkerReading& reading : load.positions) outcome.marker_sigma.push_back(reading.sigma);
    outcome.force_sigma = simulated_.wrench_factor(c) * load.force_sigma;
    outcome.torque_sigma = simulated_.wrench_factor(c) * load.torque_sigma;
    if (load.force) outcome.relative_mesh_error = simulated_.relative_force_error(c);
  }
}

bool MaterialFit::relate_stiffness(const Experiment& ends, double log_factor, FitOutcome& outcome) {
  const std::vector<FitParameter>& fitted = last_->map.fitted_parameters();
  const bool has_several = std::any_of(fitted.begin(), fitted.end(), [](const FitParameter& u) {
    return is_stiffness(u.quantity) && u.parameterization != Parameterization::uniform;
  });
  const bool has_posterior = outcome.posterior && outcome.posterior->ok && outcome.posterior->gaussian;
  if (!has_several || !has_posterior || outcome.parts) return false;
  const std::vector<double> p = with_factor(log_factor);
  std::optional<StiffnessChange> change =
      aspic::stiffness_change(ends, {last_->map, mesh(), p}, *outcome.posterior->gaussian, plan_.equilibrium);
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

std::vector<MaterialParameters> MaterialFit::material_at(double log_factor) const {
  return last_->map.parameters(with_factor(log_factor));
}

std::vector<double> MaterialFit::with_factor(double log_factor) const {
  std::vector<double> p = described_;
  if (change_) {
    add_scaled(log_factor, change_->p, p);
    return p;
  }
  for (size_t u = 0; u < last_->map.fitted_parameters().size(); ++u) {
    if (!is_stiffness(last_->map.fitted_parameters()[u].quantity)) continue;
    const auto [first, count] = last_->map.range(static_cast<int>(u));
    for (int k = first; k < first + count; ++k) p[static_cast<size_t>(k)] += log_factor;
  }
  return p;
}

bool MaterialFit::multiply_stiffness(double factor, double sigma, FitOutcome& outcome) {
  outcome_ = std::move(outcome);
  const std::vector<std::string> warnings = outcome_.warnings;
  const std::vector<double> p = with_factor(std::log(factor));
  if (change_) narrow(*change_, last_->map, sigma, *outcome_.posterior);
  for (CaseOutcome& c : outcome_.cases) c.ok = false;
  if (outcome_.parts) {
    for (double& value : outcome_.parts->values) value *= factor;
    for (Interval& interval : outcome_.parts->intervals) interval.lower *= factor, interval.upper *= factor;
  }
  describe(*last_, p);
  predict_left_out(last_->map, p);
  outcome_.warnings = warnings;
  outcome = std::move(outcome_);
  return std::all_of(outcome.cases.begin(), outcome.cases.end(), [](const CaseOutcome& c) { return c.ok; });
}

// Predicts the cases of a group with a material.
void MaterialFit::predict_group(const std::string& group, const ParameterMap& map, std::span<const double> p,
                                const UsePrediction& use) {
  const Experiment part = subset(simulated_.all(), [&](const LoadCase& c) { return c.group == group; });
  Misfit misfit(part, map, plan_.equilibrium);
  if (const auto x = simulated_.equilibria([&](const LoadCase& c) { return c.group == group; }); !x.empty())
    misfit.set_state(x);
  std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
  if (!misfit.evaluate(p, r)) return add_warnings({"'" + group + "' could not be predicted: " + misfit.failure()});
  int own = 0;
  for (size_t c = 0; c < data_.experiment.cases.size(); ++c) {
    if (data_.experiment.cases[c].group != group) continue;
    const CasePrediction& on_mesh = misfit.prediction(own++);
    use(outcome_.cases[c], on_mesh, simulated_.as_read_on_finer_mesh(c, on_mesh));
  }
}

void MaterialFit::predict_left_out(const ParameterMap& map, std::span<const double> p) {
  for (const std::string& group : plan_.left_out)
    predict_group(group, map, p,
                  [](CaseOutcome& outcome, const CasePrediction& on_mesh, const CasePrediction& prediction) {
                    outcome.ok = outcome.has_held_out = true;
                    outcome.markers_on_mesh = on_mesh.markers;
                    outcome.wrench_on_mesh = on_mesh.wrench;
                    outcome.markers = outcome.held_out_markers = prediction.markers;
                    outcome.wrench = outcome.held_out_wrench = prediction.wrench;
                  });
}

MaterialFit::HeldOutGroups MaterialFit::hold_out_groups(FitModel& model) {
  HeldOutGroups held_out{cross_validated(model, outcome_.report, plan_.fit, "held_out"), {}};
  if (is_field() && !is_stopped() && !jobs_.has_computed()) held_out.of_one_value = cross_validated_one_value();
  outcome_.interrupted |= jobs_.is_waiting();
  return held_out;
}

void MaterialFit::cross_validate_groups(FitModel& model) {
  if (!plan_.cross_validation || is_stopped()) return;
  HeldOutGroups held_out = hold_out_groups(model);
  if (outcome_.interrupted) return;  // the last group may be incomplete
  add_warnings(held_out.all.warnings);
  for (const HeldOut& group : held_out.all.groups)
    if (group.ok)
      predict_group(group.group, model.map, group.p,
                    [](CaseOutcome& outcome, const CasePrediction&, const CasePrediction& prediction) {
                      outcome.has_held_out = true;
                      outcome.held_out_markers = prediction.markers;
                      outcome.held_out_wrench = prediction.wrench;
                    });
  outcome_.held_out = std::move(held_out.all);
  outcome_.held_out_of_one_value = std::move(held_out.of_one_value);
}

CrossValidation MaterialFit::cross_validated(FitModel& model, const FitReport& report, FitOptions options,
                                             const std::string& name) {
  options.stop = StopToken([this] { return is_stopped(); });
  const auto observe = [&](int group, int groups, const std::string& label) {
    begin(FitStage::cross_validation,
          "'" + label + "' is held out (" + std::to_string(group + 1) + " of " + std::to_string(groups) + ")");
  };
  const HeldOutJobs jobs{jobs_, name, plan_, [this] { return is_stopped(); }};
  return cross_validate(simulated_.fitted(), model.map, *model.prior, report,
                        {options, plan_.equilibrium, observe, &simulated_.all(),
                         jobs.store(simulated_.fitted(), report), simulated_.equilibria()});
}

// Baseline for a field.
std::optional<CrossValidation> MaterialFit::cross_validated_one_value() {
  FitOptions options = plan_.fit;
  options.method = options.weight_rule = "auto";
  options.weight = -1;
  FitModel one(data_.experiment, simulated_, plan_, single_values(plan_.parameters), {{}, "", ""});
  const FitReport report = fit(one.data(), *one.prior, one.map.guess(), options);
  if (!is_success(report.status)) return std::nullopt;
  return cross_validated(one, report, options, "one_value_held_out");
}

}  // namespace aspic
