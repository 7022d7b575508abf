// Model of one stage of a fit, with its parameters, prior and stored state.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/fit_run.h"
#include "fit/common_errors.h"
#include "fit/misfit.h"

namespace aspic {

// Where the evaluations of a model are stored; nowhere if the memory has no folder.
struct StoredModel {
  const FitMemory& memory;
  std::string name, fingerprint;
};

struct FitModel {
  // `simulated`: the fitted cases on the simulated mesh; stored by reference.
  FitModel(const Experiment& data, const Experiment& simulated, const FitPlan& plan,
           std::vector<FitParameter> parameters, const StoredModel& stored);

  LeastSquares& recorded() { return journal ? static_cast<LeastSquares&>(*journal) : misfit; }
  LeastSquares& data() { return *with_layers; }  // the residuals to minimize

  ParameterMap map;
  std::unique_ptr<Regularizer> prior;
  Misfit misfit;
  std::optional<Journal> journal;
  std::optional<WithUncertainLayers> with_layers;  // wraps the recorded model
};

}  // namespace aspic
