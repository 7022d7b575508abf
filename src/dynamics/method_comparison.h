// Compares the work and the accuracy of several methods on one time step, each from the same state.
#pragma once
#include <string>
#include <vector>

#include "dynamics/simulation.h"

namespace aspic {

struct WorkPoint {
  int iteration = 0, gradients = 0, hessians = 0;  // totals up to this point
  double seconds = 0;
  double value = 0, gradient_norm = 0;  // E and |g| at this point
};

struct ComparedMethod {
  std::string name;
  SolverOptions solver;
};

struct MethodResult {
  std::string method;       // its name
  std::string description;  // including automatic choices
  StepReport report;
  std::vector<WorkPoint> work;  // initial guess, and the end of each iteration
  double seconds = 0;           // time of the fastest run
  double excess = 0;            // (E - E*) / (E at the start - E*), where E* is that of the reference
  double distance = 0;          // largest distance of a vertex from the reference [m]; NaN: the step was discarded
  double allowed_distance = 0;  // bound for the same minimizer, in the mass norm [m sqrt(kg)]; infinite in statics
  double mass_distance = 0;     // distance in the mass norm
  bool same_minimizer = false;
};

struct Comparison {
  int step = 1;                                     // number of the solved step
  StepReport reference;                             // Newton's method at the limit of double precision
  std::vector<MethodResult> results;                // in the given order
  bool has_reference = false, interrupted = false;  // if interrupted, unfinished methods are missing
};

struct ComparisonOptions {
  std::vector<ComparedMethod> methods;
  int step = 1;
  double max_seconds = 60;                                    // time limit of one method; its status is then `budget`
  std::function<void(const std::string& method)> begun = {};  // called before each method
  StopToken stop = {};                                        // polled in every iteration
};

// Advances the simulation to the step by its own method and solves the step by each method. Throws InvalidInput
// if a method is not possible or the step is not one minimization.
Comparison compare_methods(Simulation& simulation, const ComparisonOptions& options);

}  // namespace aspic
