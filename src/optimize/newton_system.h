// Linear systems of Newton's method: H d = -g for a Hessian selected by a HessianPolicy.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "linalg/conjugate_gradient.h"
#include "linalg/rank_one_updates.h"
#include "optimize/search_direction.h"

namespace aspic {

// Reuses the Hessian of an earlier iteration if one more step with it is expected to converge: Shamanskii's method
// [Kelley 1995, section 5.4.3].
class KeptHessian {
 public:
  void drop() { H_ = nullptr; }
  // Keeps the Hessian that E computed at x. E owns it and overwrites it with the next one.
  void keep(const Objective& E, const BlockSparse& H, std::span<const double> x);
  // Records a solve of H d = -g with this relative residual.
  void note_solve(double gradient_norm, double relative_residual);

  // Returns whether a step with the kept Hessian is expected to converge from this gradient norm. The step leaves about
  // | |g| - |g + H d| | / |g_previous| of g [Eisenstat and Walker 1996, choice 1].
  bool serves(double gradient_norm, const InnerAccuracy& accuracy) const;
  // Recomputes the Hessian if an observer has overwritten it.
  void restore(Objective& E);

 private:
  const BlockSparse* H_ = nullptr;
  std::vector<double> x_;  // positions of the kept Hessian
  uint64_t number_ = 0;    // its Objective::hessians_made()
  double norm_before_ = 0, predicted_norm_ = 0;
};

// Input and output of one Newton direction.
struct NewtonTask {
  Objective& E;
  std::span<const double> x, g;
  std::optional<double> value;  // E(x), if the line search compares values of E
  double forcing;               // relative residual of the linear solve
  std::span<double> d;
  DirectionReport& report;
};

class NewtonSystem {
 public:
  // truncates: whether the iterate of a solve that detected negative curvature is a direction.
  NewtonSystem(std::unique_ptr<LinearSolver> solver, bool truncates)
      : solver_(std::move(solver)), truncates_(truncates) {}
  const LinearSolver& solver() const { return *solver_; }
  bool truncates() const { return truncates_; }

  void begin();  // starts a minimization
  // Starts a direction. The first direction of a minimization ignores the deadline, because a step without any
  // direction would ignore the forces.
  void begin_direction(Objective& E, const StopToken& stop, bool is_first, double gradient_norm);

  bool solve(NewtonTask& task, const Projection& projection);
  bool has_stencils() const { return has_stencils_; }  // whether the last Hessian has any
  // Solves with the exact Hessian that solve() computed for this direction, and truncates at negative curvature.
  // Returns false if there is no exact Hessian or the solve failed.
  bool solve_truncated(NewtonTask& task);

  // Solves with the Hessian and factorization (or preconditioner) of an earlier iteration, if it is accurate enough.
  bool solve_with_kept(NewtonTask& task, const InnerAccuracy& accuracy);
  void drop_kept() { kept_.drop(); }

  // Returns whether to stop between the phases of a solve.
  bool is_late(DirectionReport& report) const {
    return report.stopped = report.stopped || (is_first_ ? stop_.requested() : stop_.stopped());
  }

 private:
  bool solve_factorized(NewtonTask& task) { return solve_factorized(task, task.g, task.forcing); }
  bool solve_factorized(NewtonTask& task, std::span<const double> g, double forcing);
  // Solves again with added springs while the direction violates stops. Returns whether any were added.
  bool avoid_stops(NewtonTask& task);
  bool has_misled(NewtonTask& task);
  bool solve_semidefinite(const BlockSparse& H, NewtonTask& task);
  bool factorize(const BlockSparse& H);
  bool add_dense_rows(NewtonTask& task, double forcing);

  std::unique_ptr<LinearSolver> solver_;
  bool truncates_;
  std::unique_ptr<LinearSolver> semidefinite_solver_ = solver_->make_semidefinite_solver();
  uint64_t analyzed_version_ = 0, semidefinite_version_ = 0;
  KeptHessian kept_;
  HasStops* stops_ = nullptr;           // of the objective, if it has any
  HasStiffRows* stiff_ = nullptr;       // the objective, if its Hessian may have stiff rows
  HasDenseRows* dense_ = nullptr;       // the objective, if its Hessian may have dense rows
  RankOneUpdates updates_;              // of these rows, once the factorized matrix has solved for them
  const BlockSparse* exact_ = nullptr;  // the last Hessian of this direction, if exact
  bool has_stencils_ = false;
  StopToken stop_;
  bool is_first_ = true;
  double gradient_norm_ = 0;
  std::vector<double> g_, d_;  // g with springs; the last direction
  // The last direction with springs: its start, and the largest feasible step along it.
  struct Sprung {
    std::vector<double> x, d;
    double reach = 0;
  } sprung_;
};

}  // namespace aspic
