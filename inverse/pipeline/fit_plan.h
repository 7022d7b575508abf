// Plan of a fit: parameters and methods of `aspic fit`, with defaults for every option.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "data/data_set.h"
#include "estimate/fit.h"
#include "model/equilibrium.h"
#include "model/parameter_map.h"
#include "model/regularizer.h"

namespace aspic {

struct FitPlan {
  std::string model = "neo_hookean";                  // or kAutoLaw
  std::vector<FitParameter> parameters;               // empty: young per tet, all others uniform; guess 0: automatic
  std::vector<std::pair<std::string, double>> known;  // uniform, not fitted: {"poisson", 0.45}
  // Reference directions of the fibres, to which their tilts refer: one per region of the mesh, ascending, or one for
  // all; empty: the model has no tilts.
  std::vector<Vec3d> fibre_directions = {};
  RegularizerOptions regularizer;
  FitOptions fit;
  EquilibriumOptions equilibrium;
  std::vector<std::string> left_out;  // groups of cases to predict instead of fitting
  bool uncertainty = true, cross_validation = true;
  int refine = 0;  // the simulated mesh splits every tet in 8, this many times
  // Number of parts of constant stiffness that replace a field per tet if they fit the data as well; < 0: the smallest
  // sufficient number, up to kMaxParts; 0: none.
  int parts = 0;
  int branches = 0;          // number of Maxwell branches for data with histories; 0: automatic, < 0: none
  bool robust = false;       // robust_loss.h instead of squares
  bool mesh_errors = false;  // correct measurements by the discretization error relative to a finer mesh
  bool law_errors = false;   // include the choice of the law in standard deviations
};

// Parses "young=tets", "poisson=uniform", "b=handles:40", "fibre_direction=regions". Throws InvalidInput.
FitParameter parse_parameter(const std::string& text);
std::string text_of(const FitParameter& parameter);
std::pair<std::string, double> parse_known(const std::string& text);  // "poisson=0.45"

inline constexpr int kMaxParts = 4;

// The same parameters, each uniform over the body but the tilts.
std::vector<FitParameter> single_values(std::vector<FitParameter> parameters);

// Factors of the guesses of stiffness to try if the first is so soft that the loads crush the body.
inline constexpr double kGuessFactors[] = {1, 10, 100, 0.1};
std::vector<FitParameter> stiffer(std::vector<FitParameter> parameters, double factor);

// Options of a fit of single values: those for fields are automatic.
FitOptions for_single_values(FitOptions options);

bool is_field(const FitPlan& plan);                   // a quantity is not uniform
bool has_many_values(const FitParameter& parameter);  // a value per tet or handle
bool has_many_values(const FitPlan& plan);

// Returns the plan with all choices that depend on data and model. Throws InvalidInput for names that the model or the
// data do not have. With model = kAutoLaw only E and nu can be named; the law adds its own.
FitPlan completed(FitPlan plan, const Measured& experiment);

// One "key = value" per line. Fits with equal text and data are bit-reproducible.
std::string text_of(const FitPlan& plan);
std::string fingerprint_of(const Experiment& experiment);

// Parameters of every tet before fitting.
std::vector<MaterialParameters> known_parameters(const FitPlan& plan, const Measured& experiment);

// Whether a plan with these FitPlan::left_out predicts a case instead of fitting it.
bool is_left_out(const std::vector<std::string>& left_out, const LoadCase& load);

}  // namespace aspic
