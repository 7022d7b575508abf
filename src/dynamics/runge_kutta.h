// One-step schemes as tables. With v_j and acc_j = acc(q_j, v_j) of the stages before and of its own,
//   q_i = q + h sum_j A_ij v_j,  v_i = v + h sum_j A_ij acc_j,
// and the step ends in
//   q_new = q + h sum_i b_i v_i,  v_new = v + h sum_i b_i acc_i.
// A stage with A_ii = 0 is explicit, and a solve with the mass matrix; one with A_ii > 0 is a minimization with
// beta = h A_ii (see implicit_stage.h) [Hairer 1996, section IV.6].
#pragma once
#include <memory>
#include <string_view>

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

// How many positions a PinPath needs for its accelerations to keep the order of a scheme.
constexpr int pin_path_points(int order) { return order + 2; }

}  // namespace aspic
