// What one stage of a fit minimizes: a model with its unknowns, its prior and its memory.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/fit_run.h"
#include "fit/common_errors.h"
#include "fit/misfit.h"

namespace aspic {

struct FitModel {
  // `simulated`: the cases that are fitted, on the mesh where they are simulated. Refers to it. With a folder in the
  // memory it is remembered there as `name`.
  FitModel(const Experiment& data, const Experiment& simulated, const FitPlan& plan, std::vector<Unknown> unknowns,
           const FitMemory& memory, const std::string& name, const std::string& fingerprint);

  LeastSquares& recorded() { return journal ? static_cast<LeastSquares&>(*journal) : misfit; }
  LeastSquares& data() { return *with_layers; }  // what is fitted

  ParameterMap map;
  std::unique_ptr<Regularizer> prior;
  Misfit misfit;
  std::optional<Journal> journal;
  std::optional<WithUncertainLayers> with_layers;  // of what is recorded
};

}  // namespace aspic
