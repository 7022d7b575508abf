// Strategies for Hessians that may be indefinite in Newton's method.
#pragma once
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "linalg/projection.h"
#include "optimize/newton_system.h"

namespace aspic {

// Selects the elements with modified Hessians in progressively projected Newton [Fernandez-Fernandez et al. 2026]:
// those with a vertex whose residual exceeds a threshold. The threshold decreases after a failed direction and
// increases after a successful one, so that few elements are modified.
class ProgressiveProjection {
 public:
  void begin() { threshold_ = kNone; }

  // Returns the selection for the residual g, 3 entries per vertex. Valid until the next call.
  Projection at(std::span<const double> g);
  bool is_complete() const { return covers_all_; }  // whether the last selection holds every element
  void tighten(std::span<const double> g);          // select more elements
  void relax();                                     // select fewer elements

 private:
  static constexpr double kNone = -1;  // no element is modified
  double threshold_ = kNone;
  bool covers_all_ = false;
  std::vector<char> marked_;
};

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
