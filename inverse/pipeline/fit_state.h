// Arguments of a fit and the data between its stages.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "pipeline/data_corrections.h"
#include "pipeline/fibre_search.h"
#include "pipeline/fit_model.h"
#include "pipeline/fit_run.h"
#include "pipeline/simulated_data.h"

namespace aspic {

struct FitState {
  // Stores references to all arguments but the plan.
  FitState(const DataSet& data, const FitPlan& plan, const FitMemory& memory, const FitCallbacks& callbacks);
  FitState(const FitState&) = delete;

  const TetMesh& mesh() const { return data.experiment.mesh; }  // mesh of the material
  bool has_corrections() const { return !data.experiment.errors.empty() || plan.robust; }
  bool has_model_errors() const { return plan.mesh_errors || plan.law_errors; }
  bool is_stopped();
  // The largest change of a correction, see DataCorrections; 0 without corrections.
  double estimate_corrections(FitModel& of, std::span<const double> at);
  void apply_corrections();
  void begin(FitStage stage, const std::string& what) const;
  void warn(std::string text) { outcome.warnings.push_back(std::move(text)); }
  // Model of `plan`, whose evaluations are stored under the name.
  FitModel model_of(const FitPlan& trial, std::vector<FitParameter> parameters, const std::string& name) const;

  const DataSet& data;
  const FitMemory& memory;
  const FitCallbacks& callbacks;
  FitJobs all_jobs;  // without storage
  FitJobs& jobs;
  FitPlan plan;
  std::string fingerprint;
  SimulatedData simulated;
  DataCorrections corrections;
  FibreSearch fibres;
  std::vector<MaterialParameters> material;  // last fitted parameters
  std::vector<double> p_of_errors;           // parameters of the first errors, if they are those of the fit
  std::optional<FitModel> model;             // model of the result
  std::vector<double> p;                     // parameters of the result
  FitOutcome outcome;
};

// Minimizes the objective of a model and stores the counts of the outcome.
FitReport fit_model(FitState& state, FitStage stage, FitModel& model, const FitOptions& options,
                    const std::vector<double>& start = {});

}  // namespace aspic
