// Properties of a time integrator.
#pragma once
#include <string_view>

namespace aspic {

enum class StabilityLimit { symplectic_euler, rk4 };

struct IntegratorFacts {
  std::string_view name;
  std::string_view tex = {};         // update rule in TeX, with the acceleration a of M a = -dV/dx - C v
  int order = 1;                     // order of accuracy in time; 0: statics
  bool is_implicit = true;           // each step minimizes
  bool is_multistep = false;         // uses the start of the previous step of the same length
  bool takes_one_iteration = false;  // performs one Newton iteration instead of a minimization
  bool minimizes_twice = false;      // per step, the second time from the first result
  bool is_backward_euler = false;    // its objective is that of backward Euler
  bool ends_beyond_minimum = false;  // extrapolates the end of a step from the minimizer
  bool gains_energy = false;         // adds energy for any step length
  StabilityLimit stability = StabilityLimit::symplectic_euler;  // stability limit if explicit

  bool is_static() const { return order == 0; }
  bool chooses_guess() const { return is_implicit && !takes_one_iteration; }
};

}  // namespace aspic
