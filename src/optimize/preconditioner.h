// A symmetric positive definite approximation B of the Hessian: first-order methods use -B^-1 g instead of -g. B is
// computed at the first iterate of a minimization and then constant.
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
  diagonal,  // the modified 3x3 diagonal blocks of the Hessian
  hessian,   // the Hessian with clamped element Hessians
  own,       // HasPreconditioner
};
std::string_view to_string(PreconditionerKind kind);
std::vector<PreconditionerKind> all_preconditioners();  // all kinds except `own`

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
  // z = B^-1 r, 3 entries per block row. The first call after begin() computes B at x. Returns false if B is not
  // positive definite or the solve failed.
  bool apply(Objective& E, std::span<const double> x, std::span<const double> r, std::span<double> z,
             DirectionReport& report);

 private:
  bool make(Objective& E, std::span<const double> x, DirectionReport& report);
  bool make_diagonal(const BlockSparse& H);
  bool factorize(const BlockSparse& B, DirectionReport& report);

  PreconditionerKind kind_;
  std::unique_ptr<LinearSolver> solver_;  // for `mass` and `hessian`
  HasPreconditioner* own_ = nullptr;      // of the objective
  bool is_made_ = false, is_definite_ = false, is_identity_ = false;
  std::optional<BlockSparse> B_;  // a copy, because the objective overwrites its Hessian
  std::vector<Mat3d> inverse_diagonal_;
  uint64_t analyzed_version_ = 0;
};

}  // namespace aspic
