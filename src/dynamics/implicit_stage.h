// One implicit stage: the q* and v* with
//   q* = a + beta v*,  v* = b + beta acc(q*, v*),  M acc = -dV/dx - dD/dx
// are where  1/2 (q - q~)' M (q - q~) + beta^2 (V(q) + D(q))  is least, with q~ = a + beta b. A damping term is told
// that a step of length beta starts in a, so that its force is C (q* - a) / beta = C v*.
#pragma once
#include <span>
#include <vector>

#include "dynamics/integrator.h"
#include "dynamics/pin_path.h"

namespace aspic {

struct StageOptions {
  double beta = 0;                   // [s]
  double time = 0;                   // of q* [s]
  double weight = 1;                 // of its forces in those of the step
  double ahead = 0;                  // from the known positions to q* [s]
  bool tries_last_increment = true;  // see GuessContext
  double part = 1;                   // of the step's time budget, by whose end this one ends
  bool once = false;                 // one Newton iteration from the known positions, without line search
};

class ImplicitStage {
 public:
  std::vector<double> a, b;  // set before solve() [m, m/s]

  // Writes q*, v* and acc; `q` and `v` hold the latest known positions and velocities before, and do when the stage
  // fails (false). With a path, pinned vertices take velocities and accelerations from it; without, from b like the
  // others.
  bool solve(const StepTools& tools, const PinPath* path, const StageOptions& options, std::span<double> q,
             std::span<double> v, std::span<double> acc, StepSolve& solve, StepForces& forces);

 private:
  void predict(const StepTools& tools, const PinPath* path, const StageOptions& options);
  MinimizeReport minimize(const StepTools& tools, const StageOptions& options, std::span<const double> q,
                          std::span<const double> v, StepSolve& solve);

  Guesser guesser_;
  std::vector<double> predicted_, q_;  // q~, the minimizer's positions
};

}  // namespace aspic
