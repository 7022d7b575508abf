// An implicit stage computes q* and v* with
//   q* = a + beta v*,  v* = b + beta acc(q*, v*),  M acc = -dV/dx - dD/dx
// as the minimum of  1/2 (q - q~)' M (q - q~) + beta^2 (V(q) + D(q))  with q~ = a + beta b. Damping terms use a step of
// length beta that starts at a, so that their force is C (q* - a) / beta = C v*.
#pragma once
#include <span>
#include <vector>

#include "dynamics/integrator.h"
#include "dynamics/pin_path.h"

namespace aspic {

struct StageOptions {
  double beta = 0;                   // [s]
  double time = 0;                   // time of q* [s]
  double weight = 1;                 // weight of its forces in the step's forces
  double ahead = 0;                  // time from the known positions to q* [s]
  bool tries_last_increment = true;  // see GuessContext
  double budget_fraction = 1;        // fraction of the step's time budget at which this stage ends
  bool once = false;                 // one Newton iteration from the known positions, without line search
  const State* previous = nullptr;   // state before the start, if a is extrapolated from both; see StepContext
  const PinPath* path = nullptr;     // velocities and accelerations of pinned vertices; null: differences of positions
};

struct StageVariables {
  std::span<double> q, v, acc;  // [m], [m/s], [m/s^2]
};

class ImplicitStage {
 public:
  std::vector<double> a, b;  // set before solve() [m, m/s]

  // On entry, q and v contain the latest positions and velocities. Writes q*, v* and acc, or returns false and keeps q
  // and v.
  bool solve(const StepTools& tools, const StageOptions& options, const StageVariables& variables, StepSolve& solve,
             StepForces& forces);

 private:
  void predict(const StepTools& tools, const StageOptions& options);
  MinimizeReport minimize(const StepTools& tools, const StageOptions& options, const StageVariables& variables,
                          StepSolve& solve);

  Guesser guesser_;
  std::vector<double> predicted_, q_;  // q~, positions of the minimizer
};

}  // namespace aspic
