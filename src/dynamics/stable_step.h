// How long a step an explicit scheme survives.
#pragma once
#include <span>

#include "dynamics/incremental_potential.h"

namespace aspic {

struct StableStep {
  double h = 0;     // 2 / (highest angular frequency): symplectic Euler is stable below [s]; infinite without stiffness
  int vertex = -1;  // which that vibration moves most
};

// Of small vibrations about the positions x, by power iteration on M^-1 K: a few per cent too long at most. Damping is
// left out. Overwrites what E was told by begin_step.
StableStep stable_step(IncrementalPotential& E, const Model& model, const Pins& pins, std::span<const double> x);

}  // namespace aspic
