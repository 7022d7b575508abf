// Which Hessian Newton's method takes where the exact one may be indefinite.
#pragma once
#include <memory>
#include <string_view>
#include <vector>

#include "optimize/newton_system.h"

namespace aspic {

class HessianPolicy {
 public:
  virtual ~HessianPolicy() = default;
  virtual void begin() {}  // a minimization
  // Writes task.d with one of the Hessians; false when none of them gives a direction.
  virtual bool compute(NewtonSystem& system, NewtonTask& task) = 0;
  // The last direction was of no use. True: compute again, there is a more cautious Hessian.
  virtual bool retreat() { return false; }
};

// exact, clamped, absolute: always this one.
// on_demand: exact first; clamped only when the exact Hessian turns out indefinite or its direction of no use; absolute
// where a full step along that overshoots, and for a while after that. Directions along which E curves downwards are
// lengthened, and truncated ones of the exact Hessian take over where the iterates creep away from a saddle.
// progressive: exact first; then clamped where the residual is largest, and further around, as far as it takes.
enum class NewtonDefiniteness { exact, clamped, absolute, on_demand, progressive };
std::string_view to_string(NewtonDefiniteness definiteness);
std::vector<NewtonDefiniteness> all_definiteness();
std::unique_ptr<HessianPolicy> make_hessian_policy(NewtonDefiniteness definiteness);

}  // namespace aspic
