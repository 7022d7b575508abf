// Fits Maxwell branches (a Prony series) to histories of loads, such as ramps that are held and creep tests.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/stop_token.h"
#include "estimate/uncertainty.h"
#include "model/history_curves.h"
#include "model/load_history.h"

namespace aspic {

inline constexpr int kMaxBranches = 3;
using MaterialOfScale = std::function<std::vector<MaterialParameters>(double log_scale)>;

struct RelaxationOptions {
  int branches = 0;        // 0: chosen by the evidence, from 1 to kMaxBranches
  double scale_sigma = 2;  // prior standard deviation of the logarithm of the factor of the stiffness; 0: it is 1
  // Parameters of every tet at a logarithm of the factor; empty: it multiplies all stiffnesses.
  MaterialOfScale material_at = {};
  EquilibriumOptions equilibrium;
  StopToken stop = {};
  std::function<void(const std::string& what)> begin = {};  // called before each fit
};

struct FittedBranch {
  double ratio = 0, time = 0;              // see RelaxationBranch
  double fraction = 0;                     // of the shear modulus for fast loads: ratio / (1 + sum of the ratios)
  Interval ratio_interval, time_interval;  // 95 %
};

// A number of branches that was tried.
struct BranchTrial {
  int count = 0;
  std::string failure;  // empty: none
  double squares = 0;   // |r|^2
  double evidence = 0;  // log, up to a constant
};

struct RelaxationFit {
  std::string failure;  // why there are no branches; empty: none
  bool is_stopped = false;
  std::vector<FittedBranch> branches;  // from the shortest time on
  double scale = 1;                    // factor of the stiffness of the material: of its long-term response
  Interval scale_interval;             // 95 %
  double scale_sigma = 0;              // standard deviation of log scale; 0: known
  int residuals = 0;
  double squares = 0;       // |r|^2
  double noise_factor = 1;  // applied to the standard deviations
  std::vector<BranchTrial> trials;
  std::vector<HistoryPrediction> predictions;  // one per history
  std::vector<HistoryCurve> curves;
  std::string undetermined;  // first branch that the readings do not determine; empty: none
  std::vector<std::string> warnings;

  bool is_ok() const { return failure.empty() && !is_stopped; }
};

// `material`: long-term response without branches; its stiffness is fitted up to a common factor. Derivatives are
// differences of simulations, because there are at most seven parameters. Simulations run in parallel, bit-reproducibly
// for any number of threads. Requires at least one history with readings.
RelaxationFit fit_relaxation(const Experiment& body, const std::vector<LoadHistory>& histories,
                             const ViscoelasticMaterial& material, const RelaxationOptions& options);

}  // namespace aspic
