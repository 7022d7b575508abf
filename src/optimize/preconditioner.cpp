#include "optimize/preconditioner.h"

#include <algorithm>

#include "base/stopwatch.h"
#include "linalg/conjugate_gradient.h"

namespace aspic {
namespace {

// Relative residual of an iterative solve: B may be approximate, but must be the same operator each time.
constexpr double kTolerance = 1e-2;
constexpr int kSolves = 20;  // approximate number per minimization

std::unique_ptr<LinearSolver> solver_for(PreconditionerKind kind, std::string_view linear) {
  if (kind == PreconditionerKind::hessian) return make_linear_solver(linear, kSolves);
  if (kind == PreconditionerKind::mass) return std::make_unique<ConjugateGradient>();  // well conditioned
  return nullptr;
}

}  // namespace

// In the order of PreconditionerKind.
constexpr std::string_view kPreconditionerKindNames[] = {"none", "mass", "diagonal", "hessian", "own"};

std::string_view to_string(PreconditionerKind kind) { return kPreconditionerKindNames[static_cast<size_t>(kind)]; }

std::vector<PreconditionerKind> all_preconditioners() {
  return {PreconditionerKind::none, PreconditionerKind::mass, PreconditionerKind::diagonal,
          PreconditionerKind::hessian};
}

Preconditioner::Preconditioner(PreconditionerKind kind, std::string_view linear)
    : kind_(kind), solver_(solver_for(kind, linear)) {}

std::string Preconditioner::description() const {
  const std::string name(to_string(kind_));
  return kind_ == PreconditionerKind::hessian ? name + " (" + solver_->description() + ")" : name;
}

bool Preconditioner::apply(Objective& E, std::span<const double> x, std::span<const double> r, std::span<double> z,
                           DirectionReport& report) {
  if (!is_made_) is_definite_ = make(E, x, report);
  is_made_ = true;
  if (own_) return own_->precondition(r, z);
  if (!is_definite_) return false;
  if (is_identity_) {
    std::copy(r.begin(), r.end(), z.begin());
  } else if (kind_ == PreconditionerKind::diagonal) {
    multiply_blocks(inverse_diagonal_, r, z);
  } else {
    Stopwatch stopwatch;
    const SolveReport solved = solver_->solve(r, z, kTolerance);
    report.add(solved);
    report.solve_seconds += stopwatch.lap();
    return solved.ok;
  }
  return true;
}

bool Preconditioner::make(Objective& E, std::span<const double> x, DirectionReport& report) {
  own_ = kind_ == PreconditionerKind::own ? &dynamic_cast<HasPreconditioner&>(E) : nullptr;
  if (own_) return true;
  auto* metric = kind_ == PreconditionerKind::mass ? E.traits().metric : nullptr;
  is_identity_ = kind_ == PreconditionerKind::none || (kind_ == PreconditionerKind::mass && !metric);
  if (is_identity_) return true;
  if (metric) return factorize(metric->metric(), report);
  Stopwatch stopwatch;
  const bool whole = kind_ == PreconditionerKind::hessian;
  const BlockSparse& H = E.hessian(x, {whole ? Definiteness::clamped : Definiteness::exact});
  ++report.hessians;
  report.projected_elements += E.projected_elements();
  report.hessian_seconds += stopwatch.lap();
  return whole ? factorize(H, report) : make_diagonal(H);
}

bool Preconditioner::make_diagonal(const BlockSparse& H) {
  const BlockPattern& pattern = *H.pattern;
  inverse_diagonal_.resize(pattern.rows());
  for (int row = 0; row < pattern.rows(); ++row)
    if (!invert_modified(H.block[pattern.diagonal(row)], inverse_diagonal_[row])) return false;
  return true;
}

bool Preconditioner::factorize(const BlockSparse& B, DirectionReport& report) {
  Stopwatch stopwatch;
  if (analyzed_version_ != B.pattern->version) {
    solver_->analyze(*B.pattern);
    analyzed_version_ = B.pattern->version;
    B_.emplace(*B.pattern);
  }
  std::copy(B.block.begin(), B.block.end(), B_->block.begin());
  ++report.factorizations;
  solver_->begin();
  const bool definite = solver_->factorize(*B_);
  report.factorize_seconds += stopwatch.lap();
  return definite;
}

}  // namespace aspic
