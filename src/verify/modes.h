// Natural frequencies.
#pragma once
#include <vector>

#include "dynamics/model.h"

namespace aspic::verify {

struct Mode {
  double frequency;           // [Hz]
  std::vector<double> shape;  // displacement, 3 per vertex; of any size
};

// The lowest small vibrations about rest, ascending, frequencies to nine digits: subspace iteration on
// K u = (2 pi f)^2 M u with K = d2V/dx2 and the pins held. The pins must leave no rigid motion. Throws
// std::runtime_error when it does not converge.
std::vector<Mode> modes(const Model& model, int count);
std::vector<double> frequencies(const Model& model, int count);  // of modes()

}  // namespace aspic::verify
