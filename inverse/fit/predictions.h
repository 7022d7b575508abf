// Predictions of all cases of an experiment by one material.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "fit/misfit.h"

namespace aspic {

struct Predictions {
  std::vector<CasePrediction> cases;
  std::string failure;  // not empty: some cases have no equilibrium
};

// Requires one parameter set per tet. The cases of a group are solved one after another, from the smallest load on.
Predictions predicted(const Experiment& experiment, const std::string& material,
                      std::span<const MaterialParameters> parameters, const EquilibriumOptions& options = {});

}  // namespace aspic
