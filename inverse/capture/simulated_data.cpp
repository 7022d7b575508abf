#include "capture/simulated_data.h"

#include <algorithm>
#include <cmath>

#include "capture/local_refinement.h"
#include "capture/surface_projection.h"
#include "fit/law_errors.h"

namespace aspic {
namespace {

// Data without discretization errors come from the same mesh.
bool is_refined_locally(const Experiment& data, const FitPlan& plan) {
  return plan.mesh_errors && data.mesh.tet_count() <= SimulatedData::kTooFine / kMostGrowth;
}

}  // namespace

SimulatedData::SimulatedData(const Experiment& data, const FitPlan& plan)
    : left_out_(plan.left_out),
      simulated_(refined(is_refined_locally(data, plan) ? locally_refined(data) : data, plan.refine)),
      corrected_(simulated_),
      fitted_(without_groups(simulated_, left_out_)) {}

bool SimulatedData::is_too_large_for_mesh_errors() const { return mesh().tet_count() > kTooFine; }

std::string SimulatedData::take_off_mesh_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material) {
  MeshErrors errors = mesh_errors(simulated_, plan.model, material, plan.equilibrium);
  if (errors.cases.empty()) return errors.failure;
  errors_ = std::move(errors.cases);
  correct();
  return "";
}

std::string SimulatedData::add_law_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material) {
  LawErrors errors = law_errors(simulated_, plan.model, material, plan.equilibrium);
  if (errors.cases.empty()) return errors.failure;
  law_errors_ = std::move(errors.cases);
  correct();
  return "";
}

void SimulatedData::correct() {
  corrected_ = without_mesh_errors(simulated_, {errors_, {}});
  for (size_t c = 0; c < law_errors_.size(); ++c) {
    std::vector<CommonError>& all = corrected_.cases[c].common_errors;
    all.insert(all.end(), law_errors_[c].begin(), law_errors_[c].end());
  }
  fitted_ = without_groups(corrected_, left_out_);
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

CasePrediction SimulatedData::on_finer_mesh(size_t c, const CasePrediction& prediction) const {
  CasePrediction finer = prediction;
  if (errors_.empty()) return finer;
  for (size_t k = 0; k < finer.markers.size(); ++k) finer.markers[k] = finer.markers[k] + errors_[c].markers[k];
  const Wrench error = errors_[c].for_force_on_mesh(finer.wrench.force);
  finer.wrench.force = finer.wrench.force + error.force;
  finer.wrench.torque = finer.wrench.torque + error.torque;
  return finer;
}

}  // namespace aspic
