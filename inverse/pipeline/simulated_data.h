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
  static constexpr int kTooFine = 60'000;  // limit of tets for a mesh with eight times as many. Chosen

  SimulatedData(const Measured& data, const FitPlan& plan);

  const TetMesh& mesh() const { return simulated_.mesh; }
  // All cases without systematic errors, whose values are those of the last correction.
  const Corrected& simulated() const { return simulated_; }
  // For predictions of groups that were not fitted: with the systematic errors of sessions and tips alone.
  const Corrected& all() const { return predicted_; }
  const Corrected& fitted() const { return fitted_; }
  const std::vector<CaseWeights>& weights() const { return weights_; }        // of the fitted cases; empty: 1
  const std::vector<MeshError>& mesh_errors() const { return mesh_errors_; }  // per case; empty: unknown

  // Corrects loads and readings for systematic errors of these values, and weights readings.
  void correct(std::vector<double> errors, std::vector<CaseWeights> weights);

  // Corrects the measurements by the discretization error with a material. Returns the reason if this is impossible and
  // nothing changes; otherwise an empty string.
  std::string subtract_mesh_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material);
  // The same for the choice of the law, which becomes part of the errors of the measurements.
  std::string add_law_errors(const FitPlan& plan, const std::vector<MaterialParameters>& material);
  // Positions of some cases, by default the fitted ones, one after another, at rest with the material of the last
  // errors; empty: unknown.
  std::vector<double> equilibria(const std::function<bool(const LoadCase&)>& wanted = {}) const;
  // Equilibria of the fitted cases, from which the next errors start.
  void start_from(std::span<const double> equilibria);

 private:
  void update();

  std::vector<std::string> left_out_;
  OnMesh measured_;
  Corrected simulated_;  // not for errors of mesh and law
  Corrected predicted_, fitted_;
  std::vector<CaseWeights> weights_;
  ErrorPredictions error_predictions_;  // for the last material
  std::vector<MeshError> mesh_errors_;
  std::vector<std::vector<CommonError>> law_errors_;  // per case; empty: unknown
};

bool is_too_large_for_mesh_errors(const TetMesh& mesh);
// Error of the positions: root mean square over the largest motion; < 0: unknown.
double mesh_error(const SimulatedData& data);
// Relative discretization error of the force of case c, see MeshError; 0: unknown, or below the noise of this size.
double relative_force_error(const SimulatedData& data, size_t c, double noise);
double wrench_factor(const SimulatedData& data, size_t c);
// Readings that the instruments show of a prediction for case c, corrected to a finer mesh.
CasePrediction as_read_on_finer_mesh(const SimulatedData& data, size_t c, CasePrediction prediction);

}  // namespace aspic
