// Weight of the regularizer with the largest evidence [MacKay 1992].
#pragma once
#include <span>

#include "estimate/spectrum.h"
#include "model/regularizer.h"

namespace aspic {

struct SupportedWeight {
  double factor = 1;  // relative to the weight of the fit
  double gain = 0;    // -2 log of the ratio of evidence
};

// `p`: the fit with `weight`; `spectrum`: of its data there relative to exp(-weight R).
SupportedWeight supported_weight(Regularizer& prior, double weight, std::span<const double> p,
                                 const Spectrum& spectrum);

}  // namespace aspic
