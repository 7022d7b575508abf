// Derivatives of nearly incompressible solids, see energy/mean_volume.h.
#pragma once
#include "derivatives/parameter_derivatives.h"

namespace aspic {

std::unique_ptr<ParameterDerivatives> mean_volume_derivatives(const TetElasticity& term);  // null: another kind

}  // namespace aspic
