// Runge-Kutta schemes. With v_j and acc_j = acc(q_j, v_j) of this and earlier stages j <= i, the stages are
//   q_i = q + h sum_j A_ij v_j,  v_i = v + h sum_j A_ij acc_j,
// and the step ends at
//   q_new = q + h sum_i b_i v_i,  v_new = v + h sum_i b_i acc_i.
// A stage with A_ii = 0 is explicit and solves with the mass matrix. A stage with A_ii > 0 is a minimization with beta
// = h A_ii (see implicit_stage.h) [Hairer 1996, section IV.6].
#pragma once
#include <memory>

#include "dynamics/integrator.h"

namespace aspic {

inline constexpr int kMaxStages = 4;

struct Tableau {
  IntegratorFacts facts;
  int stages = 1;
  double A[kMaxStages][kMaxStages] = {};  // lower triangular
  double b[kMaxStages] = {};
};

std::unique_ptr<Integrator> make_runge_kutta(const Tableau& tableau);

// Returns the number of PinPath positions that preserves the order of a scheme.
constexpr int pin_path_points(int order) { return order + 2; }

}  // namespace aspic
