// Minimization methods and their options, by name.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "optimize/minimize.h"

namespace aspic {

enum class NewtonDefiniteness;  // see optimize/hessian_policy.h

struct SolverOptions {
  std::string method = "newton";        // see minimizer_names()
  std::vector<std::string> fallback;    // methods to try in this order if the one before finds no step
  std::string preconditioner = "auto";  // see preconditioner_names(); "auto" depends on the method
  std::string linear = "auto";          // see linear_solver_names()
  std::string definiteness = "auto";    // see definiteness_names(); "auto": on_demand
  MinimizeOptions minimize;             // iterations, tolerance, criterion and line search
  double time_budget = 0;               // wall time per time step [s]; 0: unlimited. Results depend on the clock
};

// Return the accepted names, in the order of help texts.
std::vector<std::string> minimizer_names();       // for SolverOptions::method and its fallback
std::vector<std::string> preconditioner_names();  // for SolverOptions::preconditioner
std::vector<std::string> definiteness_names();    // for SolverOptions::definiteness
std::vector<std::string> criterion_names();       // for criterion_named()
std::vector<std::string> decrease_test_names();   // for decrease_test_named()

// Return the value for MinimizeOptions and LineSearchOptions. Throw InvalidInput for an unknown name.
Criterion criterion_named(const std::string& name);
DecreaseTest decrease_test_named(const std::string& name);

NewtonDefiniteness definiteness_of(const SolverOptions& options);  // of a valid name

// An unknown name, or an option that none of the selected methods uses.
struct SolverConflict {
  std::string option;  // the member of SolverOptions, or "criterion" for that of `minimize`
  std::string reason;  // option, value, conflict and remedy
};
// Returns the first conflict; empty if the options are valid.
std::optional<SolverConflict> find_conflict(const SolverOptions& options);

// Returns whether the iterate x plus the direction d of the method estimates the minimizer, as some criteria require;
// false for an unknown name.
bool estimates_minimizer(const std::string& method);

// Returns the search direction of the method with its fallbacks, preconditioner and linear solver. Throws InvalidInput
// if the options conflict.
std::unique_ptr<SearchDirection> make_search_direction(const SolverOptions& options);

}  // namespace aspic
