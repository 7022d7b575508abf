// How a function is minimized, by names: the methods and what each of them can be told.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "optimize/minimize.h"

namespace aspic {

struct SolverOptions {
  std::string method = "newton";        // see minimizer_names()
  std::vector<std::string> fallback;    // methods that take over, in this order, where the one before finds no step
  std::string preconditioner = "auto";  // see preconditioner_names(); "auto": what suits the method
  std::string linear = "auto";          // see linear_solver_names()
  std::string definiteness = "auto";    // see definiteness_names(); "auto": on_demand
  MinimizeOptions minimize;
  double time_budget = 0;  // [s] of wall time for a time step; 0: none. Results then depend on the clock
};

std::vector<std::string> minimizer_names();
std::vector<std::string> preconditioner_names();
std::vector<std::string> definiteness_names();
std::vector<std::string> criterion_names();
std::vector<std::string> decrease_test_names();

Criterion criterion_named(const std::string& name);         // throws InvalidInput: an unknown name
DecreaseTest decrease_test_named(const std::string& name);  // throws InvalidInput: an unknown name

// A name that is unknown, or that none of the chosen methods has a use for.
struct SolverConflict {
  std::string option;  // the member of SolverOptions; "criterion" for that of `minimize`
  std::string reason;  // the option, its value, why it does not do and what would
};
std::optional<SolverConflict> find_conflict(const SolverOptions& options);

// Whether the directions of the method tell how far the minimum is; false for an unknown name.
bool estimates_minimiser(const std::string& method);

// Throws InvalidInput where there is a conflict.
std::unique_ptr<SearchDirection> make_search_direction(const SolverOptions& options);

}  // namespace aspic
