// What of a body is fitted, and how: the choices of `aspic fit`, with defaults that need no option.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "capture/data_set.h"
#include "fit/equilibrium.h"
#include "fit/fit.h"
#include "fit/parameter_map.h"
#include "fit/regularizer.h"

namespace aspic {

struct FitPlan {
  std::string model = "neo_hookean";
  std::vector<Unknown> unknowns;                      // empty: young per tet, everything else one value; guess 0: found
  std::vector<std::pair<std::string, double>> known;  // the same in every tet, not fitted: {"poisson", 0.45}
  RegularizerOptions belief;
  FitOptions fit;
  EquilibriumOptions equilibrium;
  std::vector<std::string> left_out;  // groups of cases that are predicted, not fitted
  bool uncertainty = true, cross_validation = true;
  int refine = 0;  // the body is simulated on the mesh of the data with every tet in 8, so often
  // Number of parts of constant stiffness into which a field per tet is divided if that explains the data as well;
  // < 0: the smallest sufficient number, up to kMostParts; 0: none.
  int parts = 0;
  bool mesh_errors = false;  // what the mesh gets wrong is computed on a finer one and taken off the measurements
};

// "young=tets", "poisson=uniform", "b=handles:40". Throws InvalidInput.
Unknown parse_unknown(const std::string& text);
std::string text_of(const Unknown& unknown);
std::pair<std::string, double> parse_known(const std::string& text);  // "poisson=0.45"

inline constexpr int kMostParts = 4;

// One value for the whole body of each.
std::vector<Unknown> single_values(std::vector<Unknown> unknowns);

// The plan with everything filled in that the data and the model decide. Throws InvalidInput for names that the model
// or the data do not have.
FitPlan completed(FitPlan plan, const Experiment& experiment);

// One "key = value" per line: two fits with the same text, of the same data, are the same to the bit.
std::string text_of(const FitPlan& plan);
std::string fingerprint_of(const Experiment& experiment);

// What every tet has where nothing is fitted.
std::vector<MaterialParameters> known_parameters(const FitPlan& plan, const Experiment& experiment);

// Without the cases of some groups, or with them alone.
Experiment without_groups(const Experiment& experiment, const std::vector<std::string>& groups);
std::vector<std::string> groups_of(const Experiment& experiment);  // in their order

}  // namespace aspic
