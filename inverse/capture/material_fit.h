// The stages of a fit, one after another, and what they leave to each other.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capture/fit_model.h"
#include "capture/fit_run.h"
#include "capture/simulated_data.h"
#include "fit/parts.h"

namespace aspic {

class MaterialFit {
 public:
  // Refers to all but the plan.
  MaterialFit(const DataSet& data, const FitPlan& plan, const FitMemory& memory, const FitCallbacks& callbacks);
  FitOutcome run();

 private:
  // material_fit.cpp: from data to a material. False: nothing comes after it.
  bool fit_single_values(const std::string& name);
  bool has_single_values(FitModel& model, const FitReport& report);
  bool take_off_mesh_errors();  // false: they are not known, and the data remain as they are
  void fit_fields();
  void fit_and_describe();
  // One value replaces a field that the data do not support, with what was found for the reason.
  void fall_back(std::vector<FitReason> reasons);
  // Fits again as long as what the mesh gets wrong changes with the material; `model` is the last one.
  void fit_until_mesh_errors_settle(std::optional<FitModel>& model);
  FitReport fit_stage(FitStage which, FitModel& model, const FitOptions& options,
                      const std::vector<double>& start = {});

  // material_fit_results.cpp: what comes of it
  void learn_uncertainty(FitModel& model);
  void describe(FitModel& model, std::span<const double> p);
  void predict_left_out(const ParameterMap& map, std::span<const double> p);
  void cross_validate_groups(FitModel& model);
  CrossValidation cross_validated(FitModel& model, const FitReport& report, FitOptions options);
  void cross_validate_one_value();
  void find_next_poke(FitModel& model);
  using UsePrediction = std::function<void(CaseOutcome&, const CasePrediction&)>;
  void predict_group(const std::string& group, const ParameterMap& map, std::span<const double> p,
                     const UsePrediction& use);

  // material_fit_parts.cpp: the material in parts, where it is wanted and the data allow it; else that of the field
  std::vector<double> divided(FitModel& model);
  std::vector<double> keep(const Parts& parts, const ParameterMap& map, int unknown, FoundParts& found);

  void begin(FitStage stage, const std::string& what);
  bool is_stopped();
  void add_warnings(const std::vector<std::string>& more);
  bool is_field() const;
  bool has_many_values() const;                                  // a value per tet or handle
  const TetMesh& mesh() const { return data_.experiment.mesh; }  // of the material

  const DataSet& data_;
  FitPlan plan_;
  const FitMemory& memory_;
  const FitCallbacks& callbacks_;
  SimulatedData simulated_;
  std::vector<MaterialParameters> material_;  // the last that was fitted
  std::string fingerprint_;
  FitOutcome outcome_;
};

}  // namespace aspic
