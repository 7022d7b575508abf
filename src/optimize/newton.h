// Newton's method: minimise the quadratic approximation, H d = -g.
#pragma once
#include <memory>

#include "linalg/linear_solver.h"
#include "optimize/search_direction.h"

namespace aspic {

// on_demand: exact first; clamped only when the exact Hessian turns out indefinite or its direction of no use.
enum class NewtonDefiniteness { exact, clamped, absolute, on_demand };

class Newton : public SearchDirection {
 public:
  explicit Newton(std::unique_ptr<LinearSolver> solver,
                  NewtonDefiniteness definiteness = NewtonDefiniteness::on_demand);
  std::string_view name() const override { return "newton"; }
  std::string description() const override;
  void begin() override;
  bool compute(Objective& E, std::span<const double> x, std::span<const double> g, double forcing, std::span<double> d,
               DirectionReport& report) override;
  bool retreat() override;
  bool estimates_minimiser() const override { return true; }
  const LinearSolver& solver() const { return *solver_; }

 private:
  bool solve(Objective& E, std::span<const double> x, Definiteness kind, std::span<const double> g, double forcing,
             std::span<double> d, DirectionReport& report);
  std::unique_ptr<LinearSolver> solver_;
  NewtonDefiniteness definiteness_;
  uint64_t analyzed_version_ = 0;
  bool clamp_next_ = false, clamped_ = false;  // on_demand: at the next compute(), at the last one
};

}  // namespace aspic
