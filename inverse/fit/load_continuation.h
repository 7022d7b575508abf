// Small loads first: where a body is stretched far, a wrong guess may have no equilibrium or lead to a wrong minimum,
// and the small loads, which depend on the stiffness alone, give a better one.
#pragma once
#include "fit/fit.h"
#include "fit/misfit.h"

namespace aspic {

// With the first `per_group` cases of each group. Cases without a group stand for themselves.
Experiment smallest_loads(const Experiment& all, int per_group);

// Fits to the smallest load of each group, and from there to all. The report is that of the last fit, its `iterations`,
// `evaluations` and `history` those of both. `begin` is told what each fit is to.
FitReport fit_by_loads(const Experiment& all, const ParameterMap& map, Regularizer& prior,
                       std::span<const double> guess, const FitOptions& options, const EquilibriumOptions& equilibrium,
                       const FitObserver& observe = {}, const std::function<void(const Experiment&)>& begin = {});

}  // namespace aspic
