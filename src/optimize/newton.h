// Newton's method: d minimizes the quadratic approximation, H d = -g.
#pragma once
#include <memory>

#include "optimize/hessian_policy.h"
#include "optimize/search_direction.h"

namespace aspic {

// The relative residual eta of the linear systems of Newton's method: |H d + g| <= eta |g|. It is large far from the
// minimum and small near it, so that convergence is superlinear.
// eta = 0.9 (|g| / |g_previous|)^2 with a safeguard [Eisenstat and Walker 1996, choice 2].
class Forcing {
 public:
  void begin() { last_norm_ = 0; }
  // Returns eta at the next iterate, or again at the same one, within the bounds of `accuracy`.
  double at(double gradient_norm, const InnerAccuracy& accuracy);

 private:
  double last_norm_ = 0;  // 0: none yet
  double eta_ = 0;
};

class Newton : public SearchDirection {
 public:
  explicit Newton(std::unique_ptr<LinearSolver> solver, NewtonDefiniteness definiteness = NewtonDefiniteness::on_demand)
      : Newton(NewtonSystem(std::move(solver), false), definiteness) {}
  std::string_view name() const override { return system_.truncates() ? "newton_cg" : "newton"; }
  std::string description() const override;
  void begin() override;
  void note_change() override { system_.drop_kept(); }
  bool compute(const Iterate& at, std::span<double> d, DirectionReport& report) override;
  bool fall_back() override;
  bool estimates_minimizer() const override { return true; }
  const LinearSolver& solver() const { return system_.solver(); }

 private:
  friend std::unique_ptr<Newton> make_newton_cg(NewtonDefiniteness definiteness);
  Newton(NewtonSystem system, NewtonDefiniteness definiteness)
      : system_(std::move(system)), definiteness_(definiteness), policy_(make_hessian_policy(definiteness)) {}

  NewtonSystem system_;
  NewtonDefiniteness definiteness_;
  std::unique_ptr<HessianPolicy> policy_;
  Forcing forcing_;
  bool is_new_ = true;      // no direction was computed yet in this minimization
  bool used_kept_ = false;  // the last direction used the Hessian of an earlier iteration
};

// Returns a truncated Newton method: conjugate gradients stop at negative curvature and return their iterate, so that
// an indefinite Hessian needs no modification [Nocedal and Wright 2006, alg. 7.1]. The tolerance of the solves is that
// of Eisenstat and Walker. If such a direction fails, the Hessian is modified according to `definiteness`.
std::unique_ptr<Newton> make_newton_cg(NewtonDefiniteness definiteness = NewtonDefiniteness::on_demand);

}  // namespace aspic
