// The Hessians that Newton's method uses where the exact one may be indefinite.
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
  // Writes task.d. Returns false if none of the Hessians gives a direction.
  virtual bool compute(NewtonSystem& system, NewtonTask& task) = 0;
  // Called if no step along the last direction decreases E. Returns true if there is a more cautious Hessian.
  virtual bool retreat() { return false; }
};

// exact, clamped, absolute: always the same Hessian.
// on_demand: the exact Hessian; if it is indefinite or its direction fails, the clamped one; if a full step overshoots,
// absolute eigenvalues for some iterations. Directions of negative curvature are lengthened, and truncated directions
// of the exact Hessian are used where the iterates leave a saddle slowly. progressive: the exact Hessian; then clamped
// elements where the residual is largest, and more of them as needed.
enum class NewtonDefiniteness { exact, clamped, absolute, on_demand, progressive };
std::string_view to_string(NewtonDefiniteness definiteness);
std::vector<NewtonDefiniteness> all_definiteness();
std::unique_ptr<HessianPolicy> make_hessian_policy(NewtonDefiniteness definiteness);

}  // namespace aspic
