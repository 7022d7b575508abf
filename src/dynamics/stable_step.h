// How long a step an explicit scheme survives.
#pragma once
#include <span>

#include "dynamics/incremental_potential.h"

namespace aspic {

struct StableStep {
  double h = 0;             // up to which the scheme is stable [s]; infinite without stiffness
  int vertex = -1;          // which that motion moves most
  double frequency = 0;     // of that motion without damping [Hz]
  bool is_damping = false;  // it is damping, more than stiffness, that allows no longer steps
};

// Of symplectic Euler for small motions about the positions x: the h at which 4 is the largest eigenvalue of
// M^-1 (h^2 K + 2 h C), by power iteration; a few per cent too long at most. Without damping, C = 0, that is 2 /
// (highest angular frequency). Overwrites what E and the damping terms were told by begin_step.
StableStep stable_step(IncrementalPotential& E, const Model& model, const Pins& pins, std::span<const double> x);

}  // namespace aspic
