// Fitted quantities as values for display and as a material for scenes.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "pipeline/fit_run.h"

namespace aspic {

// `posterior`: posterior of the same fit; null: unknown.
std::vector<FittedQuantity> fitted_quantities(const ParameterMap& map, const TetMesh& mesh, std::span<const double> p,
                                              const Posterior* posterior);

// Lists the value of each part with its 95 % interval, in place of representative tets of the stiffness.
void show_parts(const FoundParts& parts, std::vector<FittedQuantity>& quantities);

// Returns the material in the user's numbering, with standard deviations and reductions.
FittedMaterial fitted_material(const DataSet& data, const ParameterMap& map, std::span<const double> p,
                               const std::vector<FittedQuantity>& quantities);

// Names quantities whose values are at the end of their range, or fields at their largest distance from the guess:
// "young in 3 tets".
std::vector<std::string> values_at_bound(const ParameterMap& map, std::span<const double> p);

// "(0.6, 0, 0.8), 95 % within 3.2 degrees".
std::string fibre_text(const FoundFibres& fibres);

// "a material per tet of 384, simulated on 3072 (refine = 1); positions err by ...".
std::string describe_mesh(const FitOutcome& outcome);

}  // namespace aspic
