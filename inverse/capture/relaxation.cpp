#include "capture/relaxation.h"

#include <algorithm>
#include <cmath>

#include "base/formatted.h"
#include "base/number_chars.h"
#include "fit/quantity.h"
#include "fit/refined_experiment.h"

namespace aspic {
namespace {

constexpr double kUnknownScale = 2;  // prior standard deviation of the logarithm of the stiffness without other cases
constexpr int kMaxTetsForSlowest = 3000;  // tets up to which the simulations take minutes

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
  if (data.histories_end_static) return kUnknownScale;
  for (const FittedQuantity& q : outcome.quantities)
    if (is_stiffness(q.name) && !q.sigma.empty()) {
      double squares = 0;
      for (const double sigma : q.sigma) squares += sigma * sigma / static_cast<double>(q.sigma.size());
      return std::sqrt(squares);
    }
  return kUnknownScale;
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

void multiply_stiffness(double scale, FitOutcome& outcome) {
  for (FittedQuantity& q : outcome.quantities) {
    if (!is_stiffness(q.name)) continue;
    for (double& value : q.values) value *= scale;
    for (ValueRow& row : q.rows) {
      row.value *= scale;
      if (row.interval) row.interval->lower *= scale, row.interval->upper *= scale;
    }
  }
  for (auto& [name, values] : outcome.material.values)
    if (is_stiffness(name))
      for (double& value : values) value *= scale;
}

// The stiffness of the whole body is that of the histories, with their interval.
void use_interval(const RelaxationFit& fit, FitOutcome& outcome) {
  for (FittedQuantity& q : outcome.quantities)
    if (is_stiffness(q.name) && q.rows.size() == 1)
      q.rows.front().interval = Interval{q.rows.front().value / fit.scale * fit.scale_interval.lower,
                                         q.rows.front().value / fit.scale * fit.scale_interval.upper};
}

}  // namespace

void add_relaxation(const DataSet& data, const FitCallbacks& callbacks, FitOutcome& outcome) {
  if (callbacks.begin) callbacks.begin(FitStage::relaxation, "relaxation times");
  if (data.experiment.mesh.tet_count() > kMaxTetsForSlowest)
    outcome.warnings.push_back("relaxation times are fitted by hundreds of simulations of " +
                               std::to_string(data.experiment.mesh.tet_count()) +
                               " tets: a coarser mesh is much faster");
  ViscoelasticMaterial material{outcome.plan.model, parameters_of(data, outcome), {}};
  const std::vector<double> factors = mesh_factors(data, outcome, material.parameters);
  const std::vector<LoadHistory> histories = on_mesh(data.histories, factors);
  const RelaxationOptions options{.branches = outcome.plan.branches,
                                  .scale_sigma = scale_sigma(data, outcome),
                                  .equilibrium = outcome.plan.equilibrium,
                                  .stop = callbacks.stop,
                                  .begin = [&](const std::string& what) {
                                    if (callbacks.begin) callbacks.begin(FitStage::relaxation, what);
                                  }};
  RelaxationFit fit = fit_relaxation(data.experiment, histories, material, options);
  if (fit.is_stopped) outcome.interrupted = true;
  for (size_t h = 0; h < fit.curves.size(); ++h) {
    fit.curves[h].measured = data.histories[h].forces;
    for (double& force : fit.curves[h].fitted) force *= factors[h];
  }
  if (fit.is_ok()) {
    multiply_stiffness(fit.scale, outcome);
    if (data.histories_end_static) use_interval(fit, outcome);
  }
  outcome.warnings.insert(outcome.warnings.end(), fit.warnings.begin(), fit.warnings.end());
  outcome.relaxation = std::move(fit);
}

std::string scene_text(const RelaxationFit& fit) {
  std::string text;
  for (const FittedBranch& branch : fit.branches)
    text += "[[body.viscoelastic]]\nratio = " + number_text(branch.ratio) +
            "\nrelaxation_time = " + number_text(branch.time) + "\n\n";
  return text;
}

}  // namespace aspic
