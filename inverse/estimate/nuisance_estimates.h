// Estimates of the bounded nuisance parameters of a fit, with their posterior standard deviations.
#pragma once
#include <span>
#include <vector>

#include "estimate/spectrum.h"
#include "model/common_errors.h"

namespace aspic {

struct NuisanceEstimate {
  double value = 0;
  double sigma = -1;  // < 0: unknown
};

// Evaluates and linearizes `data` at p. `posterior` of p: null if it is unknown. An empty result means that `data`
// cannot be evaluated there.
std::vector<NuisanceEstimate> nuisance_estimates(WithUncertainLayers& data, std::span<const double> p,
                                                 Gaussian* posterior);

}  // namespace aspic
