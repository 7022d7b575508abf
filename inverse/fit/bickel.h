// The mode of [Bickel 2009], to compare with: per example a linear co-rotated material that explains it, the moduli
// interpolated in strain space, simulated by incremental loading. Marked non-conservative: what it predicts is not the
// minimizer of an energy and depends on the path (docs/bickel.md). Also simpler baselines.
#pragma once
#include <string>
#include <vector>

#include "fit/cross_validation.h"
#include "fit/fit.h"
#include "fit/incremental_elasticity.h"
#include "fit/misfit.h"

namespace aspic {

struct BickelOptions {
  // Of each example: log E as one value, per region, at handles or per tet, nu as one value.
  Spread spread = Spread::handles;
  int handles = 12;
  double young = 1e5, poisson = 0.4;  // guesses [Pa], [1]
  bool fits_poisson = true;
  RegularizerOptions prior;
  FitOptions fit = {.weight = 1};
  EquilibriumOptions equilibrium;
  // Of the simulation.
  StressRule rule = StressRule::incremental;
  int increments = 16;
  double tolerance = 1e-6;   // of the forces that do not balance, relative to those of the tip or load
  int max_iterations = 200;  // per increment
};

// The linear co-rotated material (registered as corotated) that explains one case, by itself.
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
  CasePrediction prediction;  // `solve` is of no meaning: nothing is minimized
  int iterations = 0;
  double work = 0;  // done on the body in the increments [J]
};

// The case by incremental loading: the tip goes from where it touches to its pose, weight and pressure grow, in equal
// parts. `back`: and the same way back, so that the prediction is of the body unloaded again.
enum class Path { load, load_and_back };
BickelPrediction simulate(const Experiment& experiment, const LoadCase& load, const StrainSpaceModuli& moduli,
                          const BickelOptions& options, Path path = Path::load);

enum class Baseline {
  homogeneous,         // one E and nu for all cases of the training
  per_example_linear,  // the linear material of the case whose tip stood nearest
  bickel,
  bickel_total,  // the same with StressRule::total: moduli taken for what they were fitted as
};
std::string_view name(Baseline baseline);

// Fits to `training`, predicts the cases of `left_out` (of the same body) and compares.
HeldOut predict(Baseline baseline, const Experiment& training, const Experiment& left_out,
                const BickelOptions& options);

}  // namespace aspic
