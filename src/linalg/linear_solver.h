// Solves H x = b for a symmetric positive definite H: analyze() once per pattern, factorize() once per matrix,
// solve() once per right-hand side.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/stop_token.h"
#include "linalg/block_sparse.h"
#include "linalg/stiff_rows.h"

namespace aspic {

struct SolveReport {
  bool ok = false;               // the residual is below the tolerance
  bool indefinite = false;       // negative curvature was found
  bool stopped = false;          // the stop token ended the solve; x is the last iterate, a descent direction for -b
  int iterations = 0;            // 0 for a direct solver
  int products = 0;              // products with H
  int cycles = 0;                // multigrid cycles
  double relative_residual = 0;  // |b - H x| / |b|; 0 when not measured
};

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual std::string_view name() const = 0;                               // as in linear_solver_names()
  virtual std::string description() const { return std::string(name()); }  // method and reason for its choice, for logs
  // Prepares for matrices of the pattern, which must outlive this.
  virtual void analyze(const BlockPattern& pattern) = 0;
  // Starts a new sequence of similar matrices. Discards all data of earlier matrices, so that results depend on this
  // sequence alone.
  virtual void begin() {}
  // Sets the stiff rows of subsequent matrices; null: none. They must outlive the solves. Direct solvers ignore them.
  virtual void set_stiff_rows(const StiffRows*) {}
  // Returns false if H is not positive definite. H must outlive the solves.
  virtual bool factorize(const BlockSparse& H) = 0;
  // Solves H x = b up to |b - H x| <= tolerance |b|; direct solvers ignore the tolerance. b, x: 3 entries per row.
  virtual SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) = 0;
  // Returns a solver for singular and indefinite matrices of the same pattern. If one has negative curvature, x is a
  // descent direction for a function with the gradient -b.
  virtual std::unique_ptr<LinearSolver> make_semidefinite_solver() const;
  // Sets the token that subsequent solves poll. Direct solvers ignore it.
  virtual void set_stop(const StopToken&) {}
};

// Returns a solver by name: "auto", "cholesky", "multigrid" or "block_jacobi" (conjugate gradients). Throws
// InvalidInput for another name. `solves`: expected number of right-hand sides per factorization; used by "auto".
std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name, int solves = 1);
std::vector<std::string> linear_solver_names();  // names that make_linear_solver() accepts

}  // namespace aspic
