// Newton's method: d minimizes the quadratic approximation, H d = -g.
#pragma once
#include <memory>

#include "optimize/forcing.h"
#include "optimize/hessian_policy.h"

namespace aspic {

class Newton : public SearchDirection {
 public:
  explicit Newton(std::unique_ptr<LinearSolver> solver, NewtonDefiniteness definiteness = NewtonDefiniteness::on_demand)
      : Newton(NewtonSystem(std::move(solver), false), definiteness) {}
  std::string_view name() const override { return system_.truncates() ? "newton_cg" : "newton"; }
  std::string description() const override;
  void begin() override;
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
