// Newton's method: minimise the quadratic approximation, H d = -g.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "linalg/conjugate_gradient.h"
#include "optimize/forcing.h"
#include "optimize/kept_hessian.h"
#include "optimize/progressive_projection.h"
#include "optimize/search_direction.h"

namespace aspic {

// on_demand: exact first; clamped only when the exact Hessian turns out indefinite or its direction of no use; absolute
// where a full step along that overshoots, and for a while after that. Directions along which E curves downwards are
// lengthened, and truncated ones of the exact Hessian take over where the iterates creep away from a saddle.
// progressive: exact first; then clamped where the residual is largest, and further around, as far as it takes.
enum class NewtonDefiniteness { exact, clamped, absolute, on_demand, progressive };
std::string_view to_string(NewtonDefiniteness definiteness);
std::vector<NewtonDefiniteness> all_definiteness();

class Newton : public SearchDirection {
 public:
  explicit Newton(std::unique_ptr<LinearSolver> solver,
                  NewtonDefiniteness definiteness = NewtonDefiniteness::on_demand);
  std::string_view name() const override { return truncated_ ? "newton_cg" : "newton"; }
  std::string description() const override;
  void begin() override;
  bool compute(Objective& E, std::span<const double> x, std::span<const double> g, const InnerAccuracy& accuracy,
               std::span<double> d, DirectionReport& report) override;
  bool retreat() override;
  bool estimates_minimiser() const override { return true; }
  const LinearSolver& solver() const { return *solver_; }

 private:
  friend std::unique_ptr<Newton> make_newton_cg(NewtonDefiniteness definiteness);

  struct Place {  // x, what is known there, and E
    Objective& E;
    std::span<const double> x, g;
    std::optional<double> value;  // E(x), where steps are judged by E
  };
  bool solve_on_demand(const Place& at, double forcing, std::span<double> d, DirectionReport& report);
  bool solve_truncated(const Place& at, double gained, double forcing, std::span<double> d, DirectionReport& report);
  bool solve_modified(const Place& at, double forcing, std::span<double> d, DirectionReport& report);
  double lengthen(const Place& at, std::span<double> d, DirectionReport& report);
  double value_ahead(const Place& at, double alpha, std::span<const double> d, DirectionReport& report);
  bool solve_progressively(Objective& E, std::span<const double> x, std::span<const double> g, double forcing,
                           std::span<double> d, DirectionReport& report);
  bool solve(Objective& E, std::span<const double> x, const Projection& projection, std::span<const double> g,
             double forcing, std::span<double> d, DirectionReport& report);
  bool solve_semidefinite(const BlockSparse& H, std::span<const double> g, double forcing, std::span<double> d,
                          DirectionReport& report);
  bool solve_with_kept(Objective& E, std::span<const double> g, double forcing, std::span<double> d,
                       DirectionReport& report);
  bool solve_factorized(std::span<const double> g, double forcing, std::span<double> d, DirectionReport& report);
  // Whether to give up between the phases of a solve. The first iteration never does: without any, no force would act.
  bool is_late(DirectionReport& report) const {
    return report.stopped = report.stopped || (!is_first_ && deadline_.has_passed());
  }
  std::unique_ptr<LinearSolver> solver_;
  NewtonDefiniteness definiteness_;
  bool truncated_ = false;  // a solve that met negative curvature is used as far as it came
  Forcing forcing_;
  KeptHessian kept_;
  Deadline deadline_;
  bool is_new_ = true, is_first_ = true;  // begun, and nothing computed yet; the compute() under way is the first
  ProgressiveProjection progressive_;
  // Bears singular and indefinite matrices, which the first one may not.
  ConjugateGradient semidefinite_solver_{std::make_unique<BlockJacobi>(BlockJacobi::Blocks::made_definite)};
  uint64_t analyzed_version_ = 0, semidefinite_version_ = 0;
  const BlockSparse* exact_ = nullptr;  // the last Hessian that E made, if it is the exact one
  double gradient_norm_ = 0;
  bool used_kept_ = false;      // for the last direction
  bool cautious_next_ = false;  // after a retreat: project, or more than before
  bool clamped_ = false;        // on_demand: the last direction, or it is absolute
  int absolute_left_ = 0;       // on_demand: the next so many Hessians that are not exact are absolute
  int absolute_span_ = 0;       // and how many will be when a direction overshoots again
  int modified_in_a_row_ = 0;   // on_demand: directions that are not of the exact Hessian
  double last_value_ = 0;       // on_demand: E at the last iterate with such a direction
  std::vector<double> ahead_;
};

// Truncated Newton: conjugate gradients that stop where they meet negative curvature and keep what they have, so that
// an indefinite Hessian needs no projection [Nocedal and Wright 2006, alg. 7.1]. The systems are solved as exactly as
// Eisenstat and Walker ask. Where such a direction is of no use, the Hessian is clamped, if `definiteness` allows.
std::unique_ptr<Newton> make_newton_cg(NewtonDefiniteness definiteness = NewtonDefiniteness::on_demand);

}  // namespace aspic
