// Measurements for a fit: on the simulated mesh, without systematic errors and discretization error, weighted by a
// robust loss, and without held-out groups.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "model/misfit.h"
#include "model/refined_experiment.h"
#include "model/robust_loss.h"
#include "pipeline/fit_plan.h"

namespace aspic {

// Options for errors and gains, of which two digits are enough.
EquilibriumOptions rough(EquilibriumOptions options);

class SimulatedData {
 public:
  static constexpr int kTooFine = 60'000;  // limit of tets for a mesh with eight times as many

  SimulatedData(const Measured& data, const FitPlan& plan);

  const TetMesh& mesh() const { return simulated_.mesh; }
  // For predictions of groups that were not fitted: with the systematic errors of sessions and tips alone.
  const Corrected& all() const { return predicted_; }
  const Corrected& fitted() const { return fitted_; }
  const std::vector<SystematicError>& errors() const { return simulated_.errors; }
  const std::vector<CaseWeights>& weights() const { return weights_; }  // of the fitted cases; empty: 1

  // Corrects loads and readings for systematic errors of these values, and weights readings.
  void correct(std::vector<double> errors, std::vector<CaseWeights> weights);

  bool is_too_large_for_mesh_errors() const;
  // Corrects the measurements by the discretization error with a material. Returns the reason if this is impossible and
  // nothing changes; otherwise an empty string.
  std::string subtract_mesh_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material);
  // The same for the choice of the law, which becomes part of the errors of the measurements.
  std::string add_law_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material);
  // Positions of some cases, one after another, at rest with the material of the last errors; empty: unknown.
  std::vector<double> equilibria(const std::function<bool(const LoadCase&)>& wanted) const;
  std::vector<double> equilibria() const;  // of the fitted cases
  // Equilibria of the fitted cases, from which the next errors start.
  void start_from(std::span<const double> equilibria);
  // Error of the positions: root mean square over the largest motion; < 0: unknown.
  double mesh_error() const;
  // Relative discretization error of the force of case c, see MeshError; 0: unknown, or below the noise.
  double relative_force_error(size_t c) const;
  double wrench_factor(size_t c) const { return errors_.empty() ? 1 : errors_[c].factor(); }
  // Readings that the instruments show of a prediction for case c, corrected to a finer mesh.
  CasePrediction as_read_on_finer_mesh(size_t c, const CasePrediction& prediction) const;

 private:
  void update();
  Corrected without_model_errors(const Corrected& experiment) const;

  std::vector<std::string> left_out_;
  OnMesh measured_;
  Corrected simulated_;  // not for errors of mesh and law
  Corrected predicted_, fitted_;
  std::vector<CaseWeights> weights_;
  ErrorPredictions error_predictions_;                // for the last material
  std::vector<MeshError> errors_;                     // per case; empty: unknown
  std::vector<std::vector<CommonError>> law_errors_;  // per case; empty: unknown
};

}  // namespace aspic
