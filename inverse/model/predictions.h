// Predictions of all cases of an experiment by one material.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "model/misfit.h"

namespace aspic {

struct Predictions {
  std::vector<CasePrediction> cases;
  std::string failure;  // not empty: some cases have no equilibrium
};

// Requires one parameter set per tet. Cases are solved from the equilibria of `start`, if it has them. Otherwise those
// of a group are solved one after another, from the smallest load on.
Predictions predicted(const Experiment& experiment, const std::string& material,
                      std::span<const MaterialParameters> parameters, const EquilibriumOptions& options = {},
                      const Predictions& start = {});

// Predictions for errors of meshes and laws. Those of the next material start from them.
struct ErrorPredictions {
  Predictions on_mesh, other_law, stiffening_law;
  Predictions on_fine_mesh, below_fine;  // below_fine: on the mesh, for the same material
};

}  // namespace aspic
