// Newton's method: minimize the quadratic approximation, H d = -g.
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
  bool retreat() override;
  bool estimates_minimiser() const override { return true; }
  const LinearSolver& solver() const { return system_.solver(); }

 private:
  friend std::unique_ptr<Newton> make_newton_cg(NewtonDefiniteness definiteness);
  Newton(NewtonSystem system, NewtonDefiniteness definiteness)
      : system_(std::move(system)), definiteness_(definiteness), policy_(make_hessian_policy(definiteness)) {}

  NewtonSystem system_;
  NewtonDefiniteness definiteness_;
  std::unique_ptr<HessianPolicy> policy_;
  Forcing forcing_;
  bool is_new_ = true;      // begun, and nothing computed yet
  bool used_kept_ = false;  // a Hessian of an iteration before, for the last direction
};

// Truncated Newton: conjugate gradients that stop where they meet negative curvature and keep what they have, so that
// an indefinite Hessian needs no projection [Nocedal and Wright 2006, alg. 7.1]. The systems are solved as exactly as
// Eisenstat and Walker ask. Where such a direction is of no use, the Hessian is clamped, if `definiteness` allows.
std::unique_ptr<Newton> make_newton_cg(NewtonDefiniteness definiteness = NewtonDefiniteness::on_demand);

}  // namespace aspic
