// Derivatives of the tets of one material. Instantiated in a file of its own for each, as are the energies.
#pragma once
#include "derivatives/parameter_derivatives.h"

namespace aspic {

// Null if the term is of another material or element.
template <class M, class Batch>
std::unique_ptr<ParameterDerivatives> derivatives_of_material(const TetElasticity& term);

}  // namespace aspic
