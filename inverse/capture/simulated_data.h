// Measurements for a fit: on the simulated mesh, corrected by its discretization error, without held-out groups.
#pragma once
#include <string>
#include <vector>

#include "capture/fit_plan.h"
#include "fit/misfit.h"
#include "fit/refined_experiment.h"

namespace aspic {

class SimulatedData {
 public:
  static constexpr int kTooFine = 60'000;  // limit of tets for a mesh with eight times as many

  SimulatedData(const Experiment& data, const FitPlan& plan);

  const TetMesh& mesh() const { return simulated_.mesh; }
  const Experiment& all() const { return corrected_; }
  const Experiment& fitted() const { return fitted_; }

  bool is_too_large_for_mesh_errors() const;
  // Both are for a material. They return the reason if they are impossible, so that nothing changes; otherwise empty.
  // Corrects the measurements by the discretization error.
  std::string take_off_mesh_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material);
  // Includes the choice of the law in the errors of the measurements.
  std::string add_law_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material);
  // Error of the positions: root mean square over the largest motion; < 0: unknown.
  double mesh_error() const;
  // Relative discretization error of the force of case c, see MeshError; 0: unknown.
  double relative_force_error(size_t c) const { return errors_.empty() ? 0 : errors_[c].relative_force_error(); }
  double force_factor(size_t c) const { return errors_.empty() ? 1 : errors_[c].force_factor(); }
  // Prediction for case c, corrected to a finer mesh.
  CasePrediction on_finer_mesh(size_t c, const CasePrediction& prediction) const;

 private:
  void correct();

  std::vector<std::string> left_out_;
  Experiment simulated_, corrected_, fitted_;
  std::vector<MeshError> errors_;                     // per case; empty: unknown
  std::vector<std::vector<CommonError>> law_errors_;  // per case; empty: unknown
};

}  // namespace aspic
