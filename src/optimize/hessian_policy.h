// Strategies for Hessians that may be indefinite in Newton's method.
#pragma once
#include <memory>
#include <string_view>
#include <vector>

#include "optimize/newton_system.h"

namespace aspic {

class HessianPolicy {
 public:
  virtual ~HessianPolicy() = default;
  virtual void begin() {}  // starts a minimization
  // Writes task.d. Returns false if none of the Hessians yields a direction.
  virtual bool compute(NewtonSystem& system, NewtonTask& task) = 0;
  // Called if no step along the last direction decreases E. Returns whether a more cautious Hessian exists.
  virtual bool fall_back() { return false; }
};

// exact, clamped, absolute: always the same Hessian.
// on_demand: the exact Hessian; if it is indefinite or its direction fails, the clamped one; if a full step overshoots,
// absolute eigenvalues for some iterations. Directions of negative curvature are lengthened. If the iterates leave a
// saddle slowly, truncated directions of the exact Hessian are used.
// progressive: the exact Hessian; then clamped elements where the residual is largest, and more of them as needed.
enum class NewtonDefiniteness { exact, clamped, absolute, on_demand, progressive };
std::string_view to_string(NewtonDefiniteness definiteness);
std::vector<NewtonDefiniteness> all_definiteness();
std::unique_ptr<HessianPolicy> make_hessian_policy(NewtonDefiniteness definiteness);

}  // namespace aspic
