#include "fit/load_continuation.h"

#include <map>

namespace aspic {

Experiment smallest_loads(const Experiment& all, int per_group) {
  Experiment some{all.mesh, all.fixed, all.density, all.markers, {}};
  std::map<std::string, int> taken;
  for (const LoadCase& load : all.cases)
    if (load.group.empty() || ++taken[load.group] <= per_group) some.cases.push_back(load);
  return some;
}

FitReport fit_by_loads(const Experiment& all, const ParameterMap& map, Regularizer& prior,
                       std::span<const double> guess, const FitOptions& options, const EquilibriumOptions& equilibrium,
                       const FitObserver& observe, const std::function<void(const Experiment&)>& begin) {
  const auto fit_to = [&](const Experiment& experiment, std::span<const double> from, const FitOptions& how) {
    if (begin) begin(experiment);
    Misfit misfit(experiment, map, equilibrium);
    return fit(misfit, prior, from, how, observe);
  };
  const Experiment small = smallest_loads(all, 1);
  if (small.cases.size() == all.cases.size()) return fit_to(all, guess, options);
  const FitReport first = fit_to(small, guess, options);
  if (first.status == Status::interrupted || first.status == Status::budget || first.p.empty()) return first;
  FitOptions rest = options;
  rest.starts = 1;
  rest.max_iterations = std::max(1, options.max_iterations - first.iterations);
  FitReport whole = fit_to(all, first.p, rest);
  whole.iterations += first.iterations;
  whole.evaluations += first.evaluations;
  whole.products += first.products;
  whole.history.insert(whole.history.begin(), first.history.begin(), first.history.end());
  return whole;
}

}  // namespace aspic
