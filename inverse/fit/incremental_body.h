// A body under the loads of a case, equilibrated increment by increment, for bickel.h.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fit/bickel.h"
#include "fit/incremental_elasticity.h"
#include "fit/scaled_load.h"
#include "linalg/linear_solver.h"

namespace aspic {

class IncrementalBody {
 public:
  // Stores references to all arguments.
  IncrementalBody(const Experiment& experiment, const LoadCase& load, const StrainSpaceModuli& moduli,
                  const BickelOptions& options);

  // Applies this fraction of the load and solves for equilibrium. Returns false on failure; see failure().
  bool go_to(double part);

  CasePrediction prediction() const;
  const std::string& failure() const { return failure_; }
  int iterations() const { return iterations_; }
  double work() const { return body_.work(); }

 private:
  void add_loads();
  // Unbalanced forces; `size`: the largest forces so far.
  std::vector<double> residual(std::span<const double> x, double& size) const;
  void clear_held(std::vector<double>& g) const;
  bool balance();
  bool factorize();

  const Experiment& experiment_;
  const LoadCase& load_;
  const BickelOptions& options_;
  IncrementalElasticity body_;
  std::vector<std::unique_ptr<Energy>> energies_;
  std::vector<ScaledLoad*> scaled_;
  Probe* probe_ = nullptr;
  BlockPattern pattern_;
  std::unique_ptr<BlockSparse> matrix_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<double> x_;
  std::vector<bool> held_;
  std::string failure_;
  int iterations_ = 0;
  double force_size_ = 0;
};

}  // namespace aspic
