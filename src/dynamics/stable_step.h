// How long a step an explicit scheme survives.
#pragma once
#include <span>

#include "dynamics/incremental_potential.h"

namespace aspic {

struct StableStep {
  double h = 0;     // up to which the scheme is stable [s]; infinite without stiffness
  int vertex = -1;  // which that vibration moves most
};

// Of symplectic Euler: 2 / (highest angular frequency) of small vibrations about the positions x, without damping, by
// power iteration on M^-1 K: a few per cent too long at most. Overwrites what E and the damping terms were told by
// begin_step.
StableStep stable_step(IncrementalPotential& E, const Model& model, const Pins& pins, std::span<const double> x);

}  // namespace aspic
