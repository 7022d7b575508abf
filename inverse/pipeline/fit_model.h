// Model of one stage of a fit, with its parameters, prior and stored state.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/common_errors.h"
#include "model/misfit.h"
#include "pipeline/fit_run.h"
#include "pipeline/simulated_data.h"

namespace aspic {

// Where the evaluations of a model are stored; nowhere if the memory has no folder.
struct StoredModel {
  const FitMemory& memory;
  std::string name, fingerprint;
};

struct FitModel {
  // `simulated` is stored by reference. The first evaluation starts from its equilibria, if it has any.
  FitModel(const Measured& data, const SimulatedData& simulated, const FitPlan& plan,
           std::vector<FitParameter> parameters, const StoredModel& stored);

  LeastSquares& recorded() { return journal ? static_cast<LeastSquares&>(*journal) : misfit; }
  LeastSquares& data() { return *with_layers; }  // the residuals to minimize

  // The same model with all readings instead of condensed ones, in the same state.
  Misfit& of_all_readings();

  ParameterMap map;
  std::unique_ptr<Regularizer> prior;
  bool is_condensed;  // a robust loss needs each reading
  Condensed condensed;
  Misfit misfit;
  std::optional<Journal> journal;
  std::optional<WithUncertainLayers> with_layers;  // wraps the recorded model

 private:
  const SimulatedData& simulated_;
  EquilibriumOptions equilibrium_;
  std::optional<Misfit> whole_;
};

}  // namespace aspic
