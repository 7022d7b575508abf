// Runge-Kutta schemes. With v_j and acc_j = acc(q_j, v_j) of this and earlier stages j <= i,
//   q_i = q + h sum_j A_ij v_j,  v_i = v + h sum_j A_ij acc_j,
// and the step ends in
//   q_new = q + h sum_i b_i v_i,  v_new = v + h sum_i b_i acc_i.
// A stage with A_ii = 0 is explicit and solves with the mass matrix; a stage with A_ii > 0 is a minimization with
// beta = h A_ii (see implicit_stage.h) [Hairer 1996, section IV.6].
#pragma once
#include <memory>

#include "dynamics/integrator.h"

namespace aspic {

inline constexpr int kMostStages = 4;

struct Tableau {
  IntegratorFacts facts;
  int stages = 1;
  double A[kMostStages][kMostStages] = {};  // lower triangular
  double b[kMostStages] = {};
};

std::unique_ptr<Integrator> make_runge_kutta(const Tableau& tableau);

// Number of positions that a PinPath needs to keep the order of a scheme.
constexpr int pin_path_points(int order) { return order + 2; }

}  // namespace aspic
