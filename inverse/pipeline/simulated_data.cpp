#include "pipeline/simulated_data.h"

#include <algorithm>
#include <cmath>

#include "data/surface_projection.h"
#include "estimate/law_errors.h"
#include "model/systematic_errors.h"
#include "pipeline/fit_troubles.h"
#include "pipeline/local_refinement.h"

namespace aspic {
namespace {

// Data without discretization errors come from the same mesh.
bool is_refined_locally(const Measured& data, const FitPlan& plan) {
  return plan.mesh_errors && data.mesh.tet_count() <= SimulatedData::kTooFine / kMostGrowth;
}

}  // namespace

EquilibriumOptions rough(EquilibriumOptions options) {
  options.tolerance = std::max(options.tolerance, 1e-7);
  return options;
}

SimulatedData::SimulatedData(const Measured& data, const FitPlan& plan)
    : left_out_(plan.left_out),
      measured_{refined(is_refined_locally(data, plan) ? locally_refined(data) : Experiment(data), plan.refine)},
      simulated_{measured_} {
  update();
}

// Estimated errors of a group are no part of a prediction from other groups.
void SimulatedData::update() {
  std::vector<double> all, common;
  for (const SystematicError& e : simulated_.errors) {
    all.push_back(e.value);
    common.push_back(is_of_group(e) ? 0 : e.value);
  }
  simulated_ = without_errors(measured_, all);
  fitted_ =
      weighted(subset(without_model_errors(simulated_), [&](const LoadCase& c) { return !is_left_out(left_out_, c); }),
               weights_);
  predicted_ = without_model_errors(without_errors(measured_, common));
  size_t fitted = 0;
  for (LoadCase& load : predicted_.cases)
    if (fitted < fitted_.cases.size() && load.name == fitted_.cases[fitted].name) {
      const LoadCase& same = fitted_.cases[fitted++];
      for (size_t k = 0; k < load.positions.size(); ++k) load.positions[k].is_outlier = same.positions[k].is_outlier;
    }
}

Corrected SimulatedData::without_model_errors(const Corrected& experiment) const {
  Corrected corrected = without_mesh_errors(experiment, {errors_, {}});
  for (size_t c = 0; c < law_errors_.size(); ++c) {
    std::vector<CommonError>& all = corrected.cases[c].common_errors;
    all.insert(all.end(), law_errors_[c].begin(), law_errors_[c].end());
  }
  return corrected;
}

void SimulatedData::correct(std::vector<double> errors, std::vector<CaseWeights> weights) {
  for (size_t k = 0; k < errors.size(); ++k) simulated_.errors[k].value = errors[k];
  weights_ = std::move(weights);
  update();
}

bool SimulatedData::is_too_large_for_mesh_errors() const { return mesh().tet_count() > kTooFine; }

std::string SimulatedData::subtract_mesh_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material) {
  MeshErrors errors = mesh_errors(simulated_, plan.model, material, rough(plan.equilibrium), &error_predictions_);
  if (errors.cases.empty()) return errors.failure;
  errors_ = std::move(errors.cases);
  update();
  return "";
}

std::string SimulatedData::add_law_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material) {
  LawErrors errors = law_errors(simulated_, plan.model, material, rough(plan.equilibrium), &error_predictions_);
  if (errors.cases.empty()) return errors.failure;
  law_errors_ = std::move(errors.cases);
  update();
  return "";
}

std::vector<double> SimulatedData::equilibria() const {
  return equilibria([&](const LoadCase& load) { return !is_left_out(left_out_, load); });
}

void SimulatedData::start_from(std::span<const double> equilibria) {
  const size_t size = equilibria.size() / fitted_.cases.size();
  std::vector<CasePrediction>& all = error_predictions_.on_mesh.cases;
  all.resize(simulated_.cases.size());
  for (size_t c = 0; c < all.size(); ++c) {
    if (is_left_out(left_out_, simulated_.cases[c])) continue;
    all[c].x.assign(equilibria.begin(), equilibria.begin() + static_cast<std::ptrdiff_t>(size));
    equilibria = equilibria.subspan(size);
  }
}

std::vector<double> SimulatedData::equilibria(const std::function<bool(const LoadCase&)>& wanted) const {
  const std::vector<CasePrediction>& all = error_predictions_.on_mesh.cases;
  std::vector<double> x;
  for (size_t c = 0; c < all.size(); ++c) {
    if (!wanted(simulated_.cases[c])) continue;
    if (all[c].x.empty()) return {};
    x.insert(x.end(), all[c].x.begin(), all[c].x.end());
  }
  return x;
}

double SimulatedData::mesh_error() const {
  double sum = 0, largest = 0;
  int count = 0;
  for (size_t c = 0; c < errors_.size(); ++c)
    for (size_t k = 0; k < errors_[c].markers.size(); ++k, ++count) {
      const MarkerReading& reading = simulated_.cases[c].positions[k];
      const Vec3d motion = reading.position - position(simulated_.markers[reading.marker], mesh().rest);
      sum += dot(errors_[c].markers[k], errors_[c].markers[k]);
      largest = std::max(largest, dot(motion, motion));
    }
  return largest > 0 ? std::sqrt(sum / count / largest) : -1;
}

double SimulatedData::relative_force_error(size_t c) const {
  const bool is_noise = errors_.empty() || norm(errors_[c].wrench.force) < norm(measured_.cases[c].force_sigma);
  return is_noise ? 0 : errors_[c].relative_force_error();
}

CasePrediction SimulatedData::as_read_on_finer_mesh(size_t c, const CasePrediction& prediction) const {
  CasePrediction finer = prediction;
  if (!errors_.empty()) {
    for (size_t k = 0; k < finer.markers.size(); ++k) finer.markers[k] = finer.markers[k] + errors_[c].markers[k];
    const Wrench error = errors_[c].for_wrench_on_mesh(finer.wrench);
    finer.wrench.force = finer.wrench.force + error.force;
    finer.wrench.torque = finer.wrench.torque + error.torque;
  }
  return as_read(simulated_, simulated_.cases[c], std::move(finer));
}

}  // namespace aspic
