#include "scene/solver_options.h"

namespace aspic {
SolverOptions solver_options(const Value& solver) {
  const Value& search = solver["line_search"];
  SolverOptions options;
  options.method = solver["method"].text();
  for (const Value& name : solver["fallback"].array()) options.fallback.push_back(name.text());
  options.preconditioner = solver["preconditioner"].text();
  options.linear = solver["linear"].text();
  options.definiteness = solver["definiteness"].text();
  options.time_budget = solver["time_budget"].number();
  MinimizeOptions& minimize = options.minimize;
  minimize.max_iterations = solver["max_iterations"].integer();
  minimize.tolerance = solver["tolerance"].number();
  minimize.criterion = criterion_named(solver["criterion"].text());
  minimize.line_search = {.alpha_max = search["alpha_max"].number(),
                          .sufficient_decrease = search["c"].number(),
                          .shrink = search["p"].number(),
                          .tolerance = search["tol"].number(),
                          .test = decrease_test_named(search["test"].text())};
  if (const auto conflict = find_conflict(options)) throw error_at(solver[conflict->option].place, conflict->reason);
  return options;
}

}  // namespace aspic
