// Minimization methods and their options, by name.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "optimize/minimize.h"

namespace aspic {

struct SolverOptions {
  std::string method = "newton";        // see minimizer_names()
  std::vector<std::string> fallback;    // methods to try in this order if the one before finds no step
  std::string preconditioner = "auto";  // see preconditioner_names(); "auto" depends on the method
  std::string linear = "auto";          // see linear_solver_names()
  std::string definiteness = "auto";    // see definiteness_names(); "auto": on_demand
  MinimizeOptions minimize;
  double time_budget = 0;  // wall time per time step [s]; 0: unlimited. Results depend on the clock
};

// Names for the members of SolverOptions and of MinimizeOptions.
std::vector<std::string> minimizer_names();
std::vector<std::string> preconditioner_names();
std::vector<std::string> definiteness_names();
std::vector<std::string> criterion_names();
std::vector<std::string> decrease_test_names();

Criterion criterion_named(const std::string& name);         // throws InvalidInput for an unknown name
DecreaseTest decrease_test_named(const std::string& name);  // throws InvalidInput for an unknown name

// An unknown name, or an option that none of the selected methods uses.
struct SolverConflict {
  std::string option;  // the member of SolverOptions, or "criterion" for that of `minimize`
  std::string reason;  // option, value, conflict and remedy
};
std::optional<SolverConflict> find_conflict(const SolverOptions& options);

// Returns whether x + d estimates the minimizer; false for an unknown name.
bool estimates_minimizer(const std::string& method);

// Throws InvalidInput if the options conflict.
std::unique_ptr<SearchDirection> make_search_direction(const SolverOptions& options);

}  // namespace aspic
