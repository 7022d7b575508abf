// Stages of a fit, and the data between them.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimate/parts.h"
#include "model/common_errors.h"
#include "model/misfit.h"
#include "pipeline/fibre_search.h"
#include "pipeline/fit_run.h"
#include "pipeline/simulated_data.h"
#include "pipeline/stiffness_change.h"

namespace aspic {

// Where the evaluations of a model are stored; nowhere if the memory has no folder.
struct StoredModel {
  const FitMemory& memory;
  std::string name, fingerprint;
};

// Model of one stage of a fit, with its parameters, prior and stored state.
struct FitModel {
  // `simulated` is stored by reference. The first evaluation starts from its equilibria, if it has any.
  FitModel(const Experiment& data, const SimulatedData& simulated, const FitPlan& plan,
           std::vector<FitParameter> parameters, const StoredModel& stored);

  LeastSquares& recorded() { return journal ? static_cast<LeastSquares&>(*journal) : misfit; }
  LeastSquares& data() { return *with_layers; }  // the residuals to minimize

  // The same model with all readings instead of condensed ones, in the same state.
  Misfit& of_all_readings();

  ParameterMap map;
  std::unique_ptr<Regularizer> prior;
  bool is_condensed;  // a robust loss needs each reading
  Experiment fitted;  // with condensed readings
  Misfit misfit;
  std::optional<Journal> journal;
  std::optional<WithUncertainLayers> with_layers;  // wraps the recorded model

 private:
  const SimulatedData& simulated_;
  EquilibriumOptions equilibrium_;
  std::optional<Misfit> whole_;
};

class MaterialFit {
 public:
  // Stores references to all arguments but the plan.
  MaterialFit(const DataSet& data, const FitPlan& plan, const FitMemory& memory, const FitCallbacks& callbacks);
  FitOutcome run();
  // Several stiffnesses with a posterior change as StiffnessChange describes, otherwise by a common factor. Linearizes
  // at the factor and returns whether this makes a difference. `ends`: last states of histories.
  bool relate_stiffness(const Experiment& ends, double log_factor, FitOutcome& outcome);
  const std::optional<StiffnessChange>& stiffness_change() const { return change_; }
  std::vector<MaterialParameters> material_at(double log_factor) const;
  // Multiplies the fitted stiffness of the outcome of run() by a factor: values, material and predictions. Returns
  // false without an equilibrium. `sigma`: standard deviation of its logarithm.
  bool multiply_stiffness(double factor, double sigma, FitOutcome& outcome);

 private:
  // material_fit.cpp: stages from data to material. False: no further stage.
  bool fit_single_values(const std::string& name);
  bool has_single_values(FitModel& model, const FitReport& report);
  bool has_model_errors() const;
  // Errors of mesh and law for the last material; if they are unknown, the data remain unchanged. False: none, or
  // stopped.
  bool learn_model_errors();
  void subtract_mesh_errors();
  void add_law_errors();
  void fit_fields();
  void fit_and_describe();
  // Replaces an unsupported field by one value; stores the reasons.
  void fall_back(std::vector<FitReason> reasons);
  // Repeats the fit until the discretization error no longer changes with the material; `model` is the last one.
  void fit_until_mesh_errors_settle(std::optional<FitModel>& model);
  FitReport fit_stage(FitStage which, FitModel& model, const FitOptions& options,
                      const std::vector<double>& start = {});

  // material_fit_fibres.cpp: directions of fibres. False: no further stage.
  bool find_fibres();
  FibreTrial fit_fibres(FitPlan& plan, const std::string& name, const std::string& what);
  void describe_fibres(const ParameterMap& map, std::span<const double> p);
  double cone_of_fibres(const ParameterMap& map, std::span<const double> p, size_t region);

  // material_fit_results.cpp: results
  void learn_uncertainty(FitModel& model);
  void describe(FitModel& model, std::span<const double> p);
  std::vector<double> with_factor(double log_factor) const;  // parameters
  void predict_left_out(const ParameterMap& map, std::span<const double> p);
  struct HeldOutGroups {
    CrossValidation all;                          // predictions of the fit
    std::optional<CrossValidation> of_one_value;  // baseline for a field
  };
  HeldOutGroups hold_out_groups(FitModel& model);  // interrupted if a result is missing
  void cross_validate_groups(FitModel& model);
  CrossValidation cross_validated(FitModel& model, const FitReport& report, FitOptions options,
                                  const std::string& name);
  std::optional<CrossValidation> cross_validated_one_value();
  // Called with the prediction on the mesh and the one that is corrected for its discretization error.
  using UsePrediction = std::function<void(CaseOutcome&, const CasePrediction& on_mesh, const CasePrediction&)>;
  void predict_group(const std::string& group, const ParameterMap& map, std::span<const double> p,
                     const UsePrediction& use);

  // material_fit_corrections.cpp: systematic errors and weights of readings. correct_data() computes them for p and
  // returns their largest change; use_corrections() applies them to the data.
  bool has_corrections() const;
  double correct_data(FitModel& model, std::span<const double> p);
  void use_corrections();
  void list_errors(WithUncertainLayers& about_fit, std::span<const double> p);
  void list_common_errors(const WithUncertainLayers& about_fit, std::span<const double> r);
  void list_outliers();

  // material_fit_parts.cpp: values in parts if requested and supported by the data; otherwise those of the field
  std::vector<double> divided(FitModel& model);
  std::vector<double> keep(const Parts& parts, const ParameterMap& map, int unknown, FoundParts& found);

  void begin(FitStage stage, const std::string& what);
  bool is_stopped();
  void add_warnings(const std::vector<std::string>& more);
  bool is_field() const;
  bool has_many_values() const;                                  // a value per tet or handle
  const TetMesh& mesh() const { return data_.experiment.mesh; }  // mesh of the material

  const DataSet& data_;
  FitPlan plan_;
  const FitMemory& memory_;
  const FitCallbacks& callbacks_;
  SimulatedData simulated_;
  FibreSearch fibres_;
  FitJobs all_jobs_;  // without storage
  FitJobs& jobs_;
  std::vector<double> corrected_errors_, correction_steps_;
  std::vector<CaseWeights> corrected_weights_;
  std::vector<MaterialParameters> material_;  // last fitted parameters
  std::vector<double> p_of_errors_;           // parameters of the first errors, if they are those of the fit
  std::string fingerprint_;
  std::optional<FitModel> last_;   // model of the result
  std::vector<double> described_;  // parameters of the result
  std::optional<StiffnessChange> change_;
  FitOutcome outcome_;
};

}  // namespace aspic
