// The linear systems of Newton's method: H d = -g for a Hessian that a policy chooses.
#pragma once
#include <memory>
#include <optional>

#include "linalg/conjugate_gradient.h"
#include "optimize/kept_hessian.h"
#include "optimize/search_direction.h"

namespace aspic {

// Where a direction is computed, and what becomes of it.
struct NewtonTask {
  Objective& E;
  std::span<const double> x, g;
  std::optional<double> value;  // E(x), where steps are judged by E
  double forcing;               // relative residual of the linear solve
  std::span<double> d;
  DirectionReport& report;
};

class NewtonSystem {
 public:
  // truncates: a solve that met negative curvature is used as far as it came.
  NewtonSystem(std::unique_ptr<LinearSolver> solver, bool truncates)
      : solver_(std::move(solver)), truncates_(truncates) {}
  const LinearSolver& solver() const { return *solver_; }
  bool truncates() const { return truncates_; }

  void begin();  // a minimization
  // A direction. The first one of a minimization is never late: without any, no force would act.
  void begin_direction(const StopToken& stop, bool is_first, double gradient_norm);

  bool solve(NewtonTask& task, const Projection& projection);
  // With the exact Hessian that solve() made for this direction; where it has negative curvature, d is as far as the
  // solve came. False: there is none, or the solve failed.
  bool solve_truncated(NewtonTask& task);

  // With the Hessian of an iteration before, if that is good enough. The factorization, or the preconditioner, is kept
  // as well.
  bool solve_with_kept(NewtonTask& task, const InnerAccuracy& accuracy);
  void drop_kept() { kept_.drop(); }

  // Whether to give up between the phases of a solve.
  bool is_late(DirectionReport& report) const {
    return report.stopped = report.stopped || (is_first_ ? stop_.requested() : stop_.stopped());
  }

 private:
  bool solve_factorized(NewtonTask& task);
  bool solve_semidefinite(const BlockSparse& H, NewtonTask& task);

  std::unique_ptr<LinearSolver> solver_;
  bool truncates_;
  // Bears singular and indefinite matrices, which the first one may not.
  ConjugateGradient semidefinite_solver_{std::make_unique<BlockJacobi>(BlockJacobi::Blocks::made_definite)};
  uint64_t analyzed_version_ = 0, semidefinite_version_ = 0;
  KeptHessian kept_;
  const BlockSparse* exact_ = nullptr;  // the last Hessian that E made for this direction, if it is the exact one
  StopToken stop_;
  bool is_first_ = true;
  double gradient_norm_ = 0;
};

}  // namespace aspic
