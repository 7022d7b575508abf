// Natural frequencies.
#pragma once
#include <vector>

#include "dynamics/model.h"

namespace aspic::verify {

// The lowest frequencies [Hz] of small vibrations about rest, ascending, to nine digits: subspace iteration on
// K u = (2 pi f)^2 M u with K = d2V/dx2 and the pins held. The pins must leave no rigid motion. Throws
// std::runtime_error when it does not converge.
std::vector<double> frequencies(const Model& model, int count);

}  // namespace aspic::verify
