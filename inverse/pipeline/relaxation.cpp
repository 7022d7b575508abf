#include "pipeline/relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/formatted.h"
#include "base/number_chars.h"
#include "data/data_set.h"
#include "model/quantity.h"
#include "model/refined_experiment.h"
#include "pipeline/case_figures.h"
#include "pipeline/stiffness_scale.h"

namespace aspic {
namespace {

constexpr int kMaxPasses = 6;  // fits of the branches, each with the stiffness of the last one. Chosen

// Parameters of every tet, in the order of the data.
std::vector<MaterialParameters> parameters_of(const DataSet& data, const FitOutcome& outcome) {
  std::vector<MaterialParameters> all = known_parameters(outcome.plan, data.experiment);
  for (size_t t = 0; t < all.size(); ++t) {
    double young = young_modulus(all[t].lame), poisson = poisson_ratio(all[t].lame);
    for (const FittedQuantity& q : outcome.quantities) {
      const Quantity quantity = material_quantity(outcome.plan.model, q.name);
      if (quantity.role == QuantityRole::stiffness) young = q.values[t];
      if (quantity.role == QuantityRole::compressibility) poisson = q.values[t];
      if (quantity.role == QuantityRole::own) all[t].extra[static_cast<size_t>(quantity.extra)] = q.values[t];
    }
    all[t].lame = lame_from_young_poisson(young, poisson);
  }
  return all;
}

double scale_sigma(const DataSet& data, const FitOutcome& outcome) {
  if (std::none_of(outcome.quantities.begin(), outcome.quantities.end(),
                   [](const FittedQuantity& q) { return is_stiffness(q.name); }))
    return 0;  // given
  if (data.histories_end_static) return RegularizerOptions{}.prior_sigma;
  for (const FittedQuantity& q : outcome.quantities)
    if (is_stiffness(q.name) && !q.sigma.empty()) {
      double squares = 0;
      for (const double sigma : q.sigma) squares += sigma * sigma / static_cast<double>(q.sigma.size());
      return std::sqrt(squares);
    }
  return RegularizerOptions{}.prior_sigma;
}

// Last state of each history as a static case with the standard deviations of its history.
Experiment last_states(const DataSet& data) {
  Experiment ends = data.experiment;
  ends.cases.clear();
  ends.errors.clear();
  for (const LoadHistory& history : data.histories) {
    LoadCase& end = ends.cases.emplace_back(history.waypoints.back());
    end.force.reset();
    end.torque.reset();
    double sigma = std::numeric_limits<double>::infinity();
    for (const ForceReading& reading : history.forces) sigma = std::min(sigma, reading.sigma);
    if (history.forces.empty()) continue;
    end.force = Vec3d{};
    end.force_sigma = {{sigma, sigma, sigma}};
  }
  return ends;
}

// Forces in the limit of fine meshes over those on the mesh, in the last state of each history; 1 if unknown.
std::vector<double> mesh_factors(const DataSet& data, const FitOutcome& outcome,
                                 std::span<const MaterialParameters> material) {
  std::vector<double> factors(data.histories.size(), 1.0);
  if (!outcome.plan.mesh_errors) return factors;
  Experiment ends = data.experiment;
  ends.cases.clear();
  for (const LoadHistory& history : data.histories) {
    LoadCase end = history.waypoints.back();
    if (!end.force) end.force = Vec3d{};
    end.force_sigma = {{1, 1, 1}};
    if (!end.indenter && !end.grip) end.force.reset();
    ends.cases.push_back(std::move(end));
  }
  if (std::any_of(ends.cases.begin(), ends.cases.end(), [](const LoadCase& c) { return !c.force; })) return factors;
  const MeshErrors errors = mesh_errors(ends, outcome.plan.model, material, outcome.plan.equilibrium);
  for (size_t h = 0; h < errors.cases.size(); ++h) factors[h] = errors.cases[h].factor();
  return factors;
}

// Forces of a body like the mesh.
std::vector<LoadHistory> on_mesh(std::vector<LoadHistory> histories, const std::vector<double>& factors) {
  for (size_t h = 0; h < histories.size(); ++h)
    for (ForceReading& reading : histories[h].forces) reading.value /= factors[h], reading.sigma /= factors[h];
  return histories;
}

// Names of markers, and forces as measured.
void name_curves(const DataSet& data, std::span<const double> factors, RelaxationFit& fit) {
  for (HistoryCurve& curve : fit.curves) {
    if (curve.marker >= 0) {
      const std::string name = data.marker_names.empty() ? std::to_string(curve.marker)
                                                         : data.marker_names[static_cast<size_t>(curve.marker)];
      curve.reading += " of marker " + name;
      continue;
    }
    for (size_t h = 0; h < data.histories.size(); ++h)
      if (data.histories[h].name == curve.history)
        for (HistoryPoint& p : curve.points) p.measured *= factors[h], p.sigma *= factors[h], p.fitted *= factors[h];
  }
}

bool has_one_value(const FittedQuantity& q) { return q.rows.size() == 1; }

// One value has the standard deviation of the histories, which include the first fit as a prior. Of several that were
// fitted to the ends of the histories, they determine a common factor, whose uncertainty comes on top. Several that
// were fitted to static cases have the right ones, see StiffnessChange.
void use_deviation(const RelaxationFit& fit, const DataSet& data, FitOutcome& outcome) {
  for (FittedQuantity& q : outcome.quantities) {
    if (!is_stiffness(q.name) || (!has_one_value(q) && !data.histories_end_static)) continue;
    const auto combined = [&](double own) {
      return has_one_value(q) ? fit.scale_sigma : std::hypot(own, fit.scale_sigma);
    };
    for (double& sigma : q.sigma) sigma = combined(sigma);
    for (ValueRow& row : q.rows) {
      if (!row.interval && !has_one_value(q)) continue;
      const double own = row.interval ? std::log(row.interval->upper / row.interval->lower) / (2 * kSigmas95) : 0;
      const double factor = std::exp(kSigmas95 * combined(own));
      row.interval = Interval{row.value / factor, row.value * factor};
    }
    for (auto& [name, values] : outcome.material.further)
      if (name == q.name + "_deviation") values = data.numbering.tet.to_user(q.sigma);
  }
}

// The history until an earlier time inside its last segment.
LoadHistory until(LoadHistory history, double time) {
  const size_t last = history.times.size() - 1;
  const double begin = history.times[last - 1], end = history.times[last];
  if (!(time > begin && time < end)) return history;
  history.waypoints[last] =
      load_between(history.waypoints[last - 1], history.waypoints[last], (time - begin) / (end - begin));
  history.times[last] = time;
  std::erase_if(history.forces, [&](const ForceReading& reading) { return reading.time > time; });
  return history;
}

// Shows predictions of the histories for their last states, which are no equilibria because the body may still relax.
// `material`: long-term response, with the branches.
void use_last_states(const RelaxationFit& fit, const DataSet& data, const ViscoelasticMaterial& material,
                     std::span<const double> factors, FitOutcome& outcome) {
  double squares = 0;
  for (size_t c = 0; c < outcome.cases.size(); ++c) {
    CaseOutcome& shown = outcome.cases[c];
    const LoadCase& load = data.experiment.cases[c];
    for (size_t h = 0; h < data.histories.size(); ++h) {
      if (data.histories[h].waypoints.back().name != load.name || !shown.ok) continue;
      const HistoryPrediction& prediction = fit.predictions[h];
      const auto count = static_cast<std::ptrdiff_t>(load.positions.size());
      shown.markers = shown.markers_on_mesh = {prediction.markers.end() - count, prediction.markers.end()};
      const HistoryPrediction of_force = simulate(
          data.experiment, until(data.histories[h], data.case_time[c].value_or(0)), material, outcome.plan.equilibrium);
      if (!of_force.is_ok()) continue;
      shown.wrench_on_mesh = of_force.end;
      shown.wrench = {factors[h] * of_force.end.force, factors[h] * of_force.end.torque};
    }
    for_each_residual(load, shown, [&](double r) { squares += r * r; });
  }
  outcome.report.misfit = squares / 2;
}

// Material of the fit with its branches.
ViscoelasticMaterial fitted(ViscoelasticMaterial material, const RelaxationFit& fit) {
  for (MaterialParameters& m : material.parameters) m.lame.mu *= fit.scale, m.lame.lambda *= fit.scale;
  for (const FittedBranch& b : fit.branches) material.branches.push_back({b.ratio, b.time});
  return material;
}

}  // namespace

void add_relaxation(FitState& state) {
  const DataSet& data = state.data;
  const FitCallbacks& callbacks = state.callbacks;
  FitOutcome& outcome = state.outcome;
  StiffnessScale stiffness(state);
  if (callbacks.begin) callbacks.begin(FitStage::relaxation, "relaxation times");
  if (data.experiment.mesh.tet_count() > kMaxQuadratic)
    outcome.warnings.push_back("relaxation times are fitted by hundreds of simulations of " +
                               std::to_string(data.experiment.mesh.tet_count()) +
                               " tets: a coarser mesh is much faster");
  ViscoelasticMaterial material{outcome.plan.model, parameters_of(data, outcome), {}};
  const std::vector<double> factors = mesh_factors(data, outcome, material.parameters);
  const std::vector<LoadHistory> histories = on_mesh(data.histories, factors);
  const Experiment ends = last_states(data);
  const bool is_related = !data.histories_end_static && stiffness.relate(ends, 0);
  RelaxationOptions options{.branches = outcome.plan.branches,
                            .scale_sigma = scale_sigma(data, outcome),
                            .equilibrium = outcome.plan.equilibrium,
                            .stop = callbacks.stop,
                            .begin = [&](const std::string& what) {
                              if (callbacks.begin) callbacks.begin(FitStage::relaxation, what);
                            }};
  if (is_related) options.material_at = [&](double log_scale) { return stiffness.material_at(log_scale); };
  RelaxationFit fit;
  int passes = 0;
  do {
    if (is_related) options.scale_sigma = stiffness.change()->sigma;
    fit = fit_relaxation(data.experiment, histories, material, options);
  } while (is_related && fit.is_ok() && ++passes < kMaxPasses && stiffness.relate(ends, std::log(fit.scale)));
  if (passes == kMaxPasses)
    outcome.warnings.push_back("the histories and the values of stiffness did not settle in " +
                               std::to_string(kMaxPasses) + " fits: intervals of the stiffness may be too narrow");
  if (fit.is_stopped) outcome.interrupted = true;
  name_curves(data, factors, fit);
  if (fit.is_ok()) {
    const std::vector<FoundCommonError> common_errors = outcome.common_errors;
    if ((fit.scale != 1 || is_related) && !stiffness.multiply(fit.scale, fit.scale_sigma))
      fit.failure = "no equilibrium exists with the long-term stiffness, " + three_digits(fit.scale) +
                    " times that of the first fit";
    use_deviation(fit, data, outcome);
    if (data.histories_end_static) {
      outcome.common_errors = common_errors;
      use_last_states(fit, data, fitted(material, fit), factors, outcome);
    }
  }
  outcome.warnings.insert(outcome.warnings.end(), fit.warnings.begin(), fit.warnings.end());
  outcome.relaxation = std::move(fit);
}

std::string scene_text(const RelaxationFit& fit) {
  std::string text = "# Beside the fitted material, whose stiffness is the long-term one.\n";
  for (const FittedBranch& branch : fit.branches)
    text += "[[body.viscoelastic]]\nratio = " + number_text(branch.ratio) +
            "\nrelaxation_time = " + number_text(branch.time) + "\n\n";
  return text;
}

}  // namespace aspic
