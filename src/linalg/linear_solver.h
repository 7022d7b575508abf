// Solves H x = b for a symmetric positive definite H: analyze() once per pattern, factorize() once per matrix,
// solve() once per right-hand side.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/deadline.h"
#include "linalg/block_sparse.h"

namespace aspic {

struct SolveReport {
  bool ok = false;               // the residual is below the tolerance asked for
  bool indefinite = false;       // negative curvature was met
  bool stopped = false;          // the deadline passed first; x is as far as it came, a descent direction for -b
  int iterations = 0;            // 0 for a direct solver
  int products = 0;              // with H
  int cycles = 0;                // of multigrid
  double relative_residual = 0;  // |b - H x| / |b|; 0 when not measured
};

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual std::string_view name() const = 0;
  virtual std::string description() const { return std::string(name()); }  // what was chosen, and why; for logs
  virtual void analyze(const BlockPattern& pattern) = 0;
  // A sequence of matrices begins that change little from one to the next. What was kept of earlier ones is dropped, so
  // that results depend on this sequence alone.
  virtual void begin() {}
  virtual bool factorize(const BlockSparse& H) = 0;  // false: H is not positive definite. H must outlive the solves.
  // `tolerance` bounds |b - H x| / |b|; a direct solver ignores it. x holds the answer, 3 numbers per row.
  virtual SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) = 0;
  // Of the solves from now on; a direct solver takes its time.
  virtual void set_deadline(const Deadline&) {}
};

// "auto", "cholesky", "multigrid" and "block_jacobi" (conjugate gradients). Throws InvalidInput for another name.
// `solves`: how many right-hand sides share a factorisation, roughly; for "auto".
std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name, int solves = 1);
std::vector<std::string> linear_solver_names();

}  // namespace aspic
