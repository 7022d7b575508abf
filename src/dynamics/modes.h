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
  std::vector<double> shape;  // displacement u, 3 per vertex, with u' M u = 1; zero along pinned directions
};

enum class ModesStatus {
  converged,
  all_held,       // pins leave no free degree of freedom
  indefinite,     // the positions are unstable, or a vertex has neither mass nor stiffness
  out_of_memory,  // the factorization does not fit into the free memory
  unconverged,
  interrupted,  // the stop token ended the computation
};

struct Modes {
  ModesStatus status = ModesStatus::converged;
  std::vector<Mode> modes;  // ascending in frequency; fewer than requested if fewer exist
  int rigid = 0;            // number of leading modes without stiffness
};

// Computes the `count` >= 1 lowest modes of K u = (2 pi f)^2 M u, where K = d2V/dx2 at `x` (3 per vertex [m]) and time
// 0. Pins are fixed, damping is ignored, and stress at `x` contributes to K. Frequencies have about nine digits. Binds
// the terms of the model to another matrix, so a simulation of the same model must not continue.
Modes vibration_modes(const Model& model, std::span<const double> x, int count, const StopToken& stop = {});

std::string message(ModesStatus status);  // what happened and what to do

}  // namespace aspic
