// Small undamped vibrations of a model about given positions.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "base/stop_token.h"
#include "dynamics/model.h"

namespace aspic {

struct Mode {
  double frequency = 0;       // [Hz]; 0 for a rigid motion
  std::vector<double> shape;  // displacement u, 3 per vertex, with u' M u = 1; zero along what pins hold
};

enum class ModesStatus {
  converged,
  all_held,       // pins leave nothing to vibrate
  indefinite,     // the positions are unstable, or a vertex has neither mass nor stiffness
  out_of_memory,  // the factorization needs more memory than is free
  unconverged,
  interrupted,  // the stop token ended it
};

struct Modes {
  ModesStatus status = ModesStatus::converged;
  std::vector<Mode> modes;  // ascending in frequency; all that exist when there are fewer than asked for
  int rigid = 0;            // number of leading modes without stiffness
};

// Computes the `count` >= 1 lowest modes of K u = (2 pi f)^2 M u, where K = d2V/dx2 at `x` (3 per vertex [m]), time 0.
// Pins are held, damping is ignored, and stress at `x` contributes to K. Frequencies have about nine digits. The terms
// of the model are bound to another matrix afterwards, so a simulation of the same model must not continue.
Modes vibration_modes(const Model& model, std::span<const double> x, int count, const StopToken& stop = {});

std::string message(ModesStatus status);  // what happened and what to do

}  // namespace aspic
