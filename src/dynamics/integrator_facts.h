// The properties of a time integrator.
#pragma once
#include <string_view>

namespace aspic {

enum class StabilityLimit { symplectic_euler, rk4 };

struct IntegratorFacts {
  std::string_view name;
  int order = 1;                     // in time, for smooth motions; 0: statics
  bool is_implicit = true;           // minimizes
  bool is_multistep = false;         // uses where the step before started, a step of the same length ago
  bool takes_one_iteration = false;  // of Newton's method, in place of a minimization
  bool is_backward_euler = false;    // however its E is minimized
  bool ends_beyond_minimum = false;  // the end of a step is extrapolated from what was minimized
  bool gains_energy = false;         // in steps of any length
  StabilityLimit stability = StabilityLimit::symplectic_euler;  // of an explicit scheme

  bool is_static() const { return order == 0; }
  bool chooses_guess() const { return is_implicit && !takes_one_iteration; }
};

}  // namespace aspic
