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

Corrected without_model_errors(const Corrected& experiment, const std::vector<MeshError>& of_mesh,
                               const std::vector<std::vector<CommonError>>& of_law) {
  Corrected corrected = without_mesh_errors(experiment, {of_mesh, {}});
  for (size_t c = 0; c < of_law.size(); ++c) {
    std::vector<CommonError>& all = corrected.cases[c].common_errors;
    all.insert(all.end(), of_law[c].begin(), of_law[c].end());
  }
  return corrected;
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
  fitted_ = weighted(subset(without_model_errors(simulated_, mesh_errors_, law_errors_),
                            [&](const LoadCase& c) { return !is_left_out(left_out_, c); }),
                     weights_);
  predicted_ = without_model_errors(without_errors(measured_, common), mesh_errors_, law_errors_);
  size_t fitted = 0;
  for (LoadCase& load : predicted_.cases)
    if (fitted < fitted_.cases.size() && load.name == fitted_.cases[fitted].name) {
      const LoadCase& same = fitted_.cases[fitted++];
      for (size_t k = 0; k < load.positions.size(); ++k) load.positions[k].is_outlier = same.positions[k].is_outlier;
    }
}

void SimulatedData::correct(std::vector<double> errors, std::vector<CaseWeights> weights) {
  for (size_t k = 0; k < errors.size(); ++k) simulated_.errors[k].value = errors[k];
  weights_ = std::move(weights);
  update();
}

std::string SimulatedData::subtract_mesh_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material) {
  MeshErrors errors =
      aspic::mesh_errors(simulated_, plan.model, material, rough(plan.equilibrium), &error_predictions_);
  if (errors.cases.empty()) return errors.failure;
  mesh_errors_ = std::move(errors.cases);
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
    const LoadCase& load = simulated_.cases[c];
    if (wanted ? !wanted(load) : is_left_out(left_out_, load)) continue;
    if (all[c].x.empty()) return {};
    x.insert(x.end(), all[c].x.begin(), all[c].x.end());
  }
  return x;
}

bool is_too_large_for_mesh_errors(const TetMesh& mesh) { return mesh.tet_count() > SimulatedData::kTooFine; }

double mesh_error(const SimulatedData& data) {
  const std::vector<MeshError>& errors = data.mesh_errors();
  const Corrected& simulated = data.simulated();
  double sum = 0, largest = 0;
  int count = 0;
  for (size_t c = 0; c < errors.size(); ++c)
    for (size_t k = 0; k < errors[c].markers.size(); ++k, ++count) {
      const MarkerReading& reading = simulated.cases[c].positions[k];
      const Vec3d motion = reading.position - position(simulated.markers[reading.marker], data.mesh().rest);
      sum += dot(errors[c].markers[k], errors[c].markers[k]);
      largest = std::max(largest, dot(motion, motion));
    }
  return largest > 0 ? std::sqrt(sum / count / largest) : -1;
}

double relative_force_error(const SimulatedData& data, size_t c, double noise) {
  const std::vector<MeshError>& errors = data.mesh_errors();
  return errors.empty() || norm(errors[c].wrench.force) < noise ? 0 : errors[c].relative_force_error();
}

double wrench_factor(const SimulatedData& data, size_t c) {
  return data.mesh_errors().empty() ? 1 : data.mesh_errors()[c].factor();
}

CasePrediction as_read_on_finer_mesh(const SimulatedData& data, size_t c, CasePrediction prediction) {
  if (!data.mesh_errors().empty()) {
    const MeshError& error = data.mesh_errors()[c];
    for (size_t k = 0; k < prediction.markers.size(); ++k)
      prediction.markers[k] = prediction.markers[k] + error.markers[k];
    const Wrench of_wrench = error.for_wrench_on_mesh(prediction.wrench);
    prediction.wrench.force = prediction.wrench.force + of_wrench.force;
    prediction.wrench.torque = prediction.wrench.torque + of_wrench.torque;
  }
  return as_read(data.simulated(), data.simulated().cases[c], std::move(prediction));
}

}  // namespace aspic
