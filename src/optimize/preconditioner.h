// A symmetric positive definite matrix B that stands for the Hessian: first-order methods step along -B^-1 g instead of
// -g. It is made at the first iterate of a minimization and kept to its end.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "linalg/linear_solver.h"
#include "optimize/search_direction.h"

namespace aspic {

enum class PreconditionerKind {
  none,      // the identity
  mass,      // HasMetric
  diagonal,  // the 3x3 diagonal blocks of the Hessian, each made definite
  hessian,   // the Hessian with clamped elements
  own,       // HasPreconditioner
};
std::string_view to_string(PreconditionerKind kind);
std::vector<PreconditionerKind> all_preconditioners();  // that any objective can have: all but `own`

class Preconditioner {
 public:
  // `linear` names the solver for the Hessian (see linear_solver_names()).
  explicit Preconditioner(PreconditionerKind kind, std::string_view linear = "auto");

  PreconditionerKind kind() const { return kind_; }
  std::string description() const;  // "hessian (cholesky: ...)"

  void begin() { is_made_ = false; }
  void set_stop(const StopToken& stop) {
    if (solver_) solver_->set_stop(stop);
  }
  // z = B^-1 r, 3 numbers per vertex. The first call after begin() makes B at x. False: B is not positive definite, or
  // the system could not be solved.
  bool apply(Objective& E, std::span<const double> x, std::span<const double> r, std::span<double> z,
             DirectionReport& report);

 private:
  bool make(Objective& E, std::span<const double> x, DirectionReport& report);
  bool make_diagonal(const BlockSparse& H);
  bool factorize(const BlockSparse& B, DirectionReport& report);

  PreconditionerKind kind_;
  std::unique_ptr<LinearSolver> solver_;  // of mass and Hessian
  bool is_made_ = false, is_definite_ = false, is_identity_ = false;
  std::optional<BlockSparse> B_;  // a copy: the objective overwrites its Hessian
  std::vector<Mat3d> inverse_diagonal_;
  uint64_t analyzed_version_ = 0;
};

}  // namespace aspic
