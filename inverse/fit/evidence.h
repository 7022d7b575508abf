// Which weight of the regularizer the data support: the one under which they are most probable [MacKay 1992].
#pragma once
#include <span>

#include "fit/regularizer.h"
#include "fit/spectrum.h"

namespace aspic {

struct SupportedWeight {
  double factor = 1;  // times the weight of the fit
  double gain = 0;    // -2 log of the probability that is gained by it
};

// `p`: the fit with `weight`; `spectrum`: of its data there against exp(-weight R).
SupportedWeight supported_weight(Regularizer& prior, double weight, std::span<const double> p,
                                 const Spectrum& spectrum);

}  // namespace aspic
