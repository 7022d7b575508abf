// Several methods on one time step, each from the same state: how much work each needs for how much precision.
#pragma once
#include <string>
#include <vector>

#include "dynamics/simulation.h"

namespace aspic::cli {

struct WorkPoint {
  int iteration = 0, gradients = 0, hessians = 0;  // done so far
  double seconds = 0;
  double value = 0, gradient_norm = 0;  // E and |g| there
};

struct MethodResult {
  std::string method;       // as it was asked for
  std::string description;  // with what it decided
  StepReport report;
  std::vector<WorkPoint> work;  // the start, and the end of each iteration
  double seconds = 0;           // of the fastest run
  double excess = 0;            // (E - E*) / (E at the start - E*), where E* is that of the reference
  double distance = 0;          // of the vertex that is furthest from where the reference has it [m]
  double allowed_distance = 0;  // in the norm of the mass [m sqrt(kg)], see same_minimizer(); infinite in statics
  double mass_distance = 0;     // in that norm
  bool same_minimizer = false;
};

struct Comparison {
  int step = 1;                                     // which was solved
  StepReport reference;                             // Newton's method as far as double precision goes
  std::vector<MethodResult> results;                // in the order asked for
  bool has_reference = false, interrupted = false;  // then the methods that are missing were not tried to their end
};

struct ComparisonOptions {
  std::vector<std::string> methods;  // see method_named()
  int step = 1;
  double max_seconds = 60;  // of one method; what takes longer is cut off, and says so
  std::function<void(const std::string& method)> begun = {};  // called before each method
  StopToken stop = {};                                        // polled in every iteration
};

// Brings the simulation to the start of the step by its own method and solves it by each of them. Throws InvalidInput
// for an unknown method and for a step that is not one minimization.
Comparison compare_methods(Simulation& simulation, const ComparisonOptions& options);

}  // namespace aspic::cli
