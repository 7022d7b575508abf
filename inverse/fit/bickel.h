// Model of [Bickel 2009] for comparison: a linear corotated material per example, moduli interpolated in strain space,
// and incremental loading. It is not conservative: predictions minimize no energy and depend on the path
// (bench/results/strain_space.md). Also simpler baselines.
#pragma once
#include <string>

#include "fit/cross_validation.h"
#include "fit/fit.h"
#include "fit/incremental_elasticity.h"
#include "fit/misfit.h"

namespace aspic {

struct BickelOptions {
  // Parameterization of each example: log E uniform, per region, at handles or per tet; nu uniform.
  Parameterization parameterization = Parameterization::handles;
  int handles = 12;
  double young = 1e5, poisson = 0.4;  // initial guesses [Pa], [1]
  bool fits_poisson = true;
  RegularizerOptions prior;
  FitOptions fit = {.weight = 1};
  EquilibriumOptions equilibrium;
  // Stress rule of the simulation.
  StressRule rule = StressRule::incremental;
  int increments = 16;
  double tolerance = 1e-6;   // unbalanced forces, relative to those of the indenter or load
  int max_iterations = 200;  // per increment
};

// Linear corotated material (registered as corotated) fitted to one case.
struct ExplainedCase {
  bool ok = false;
  std::string failure;
  StrainExample example;
  FitReport report;
};
ExplainedCase explain(const Experiment& experiment, int load_case, const BickelOptions& options);

struct BickelPrediction {
  bool ok = false;
  std::string failure;
  CasePrediction prediction;  // `solve` is undefined: nothing is minimized
  int iterations = 0;
  double work = 0;  // accumulated work on the body [J]
};

// Simulates a case incrementally: the indenter moves from the touch to its pose, and weight and pressure grow, in equal
// increments. load_and_back also returns, so that the prediction is of the unloaded body.
enum class Path { load, load_and_back };
BickelPrediction simulate(const Experiment& experiment, const LoadCase& load, const StrainSpaceModuli& moduli,
                          const BickelOptions& options, Path path = Path::load);

enum class Baseline {
  homogeneous,         // one E and nu for all training cases
  per_example_linear,  // linear material of the training case with the nearest indenter
  bickel,
  bickel_total,  // the same with StressRule::total, the meaning with which moduli were fitted
};
std::string_view name(Baseline baseline);

// Fits to `training`, predicts the cases of `left_out` (same body) and compares.
HeldOut predict(Baseline baseline, const Experiment& training, const Experiment& left_out,
                const BickelOptions& options);

}  // namespace aspic
