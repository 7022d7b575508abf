// What was fitted, as numbers for people and as a material for scenes.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "capture/fit_run.h"

namespace aspic {

// `belief`: of the same fit; null: not known.
std::vector<FittedQuantity> fitted_quantities(const ParameterMap& map, const TetMesh& mesh, std::span<const double> p,
                                              const Posterior* belief);

// By the user's numbers, with deviations and reductions beside the values.
FittedMaterial fitted_material(const DataSet& data, const ParameterMap& map, std::span<const double> p,
                               const std::vector<FittedQuantity>& quantities);

// Quantities whose values the readings push to an end of their range, or a field to its farthest from the guess:
// "young in 3 tets".
std::vector<std::string> values_at_bound(const ParameterMap& map, std::span<const double> p);

// "a material per tet of 384, simulated on 3072 (refine = 1); positions err by ...".
std::string words_of_mesh(const FitOutcome& outcome);

}  // namespace aspic
