#include "linalg/linear_solver.h"

#include "base/error.h"
#include "linalg/auto_solver.h"
#include "linalg/cholesky.h"
#include "linalg/conjugate_gradient.h"
#include "linalg/multigrid.h"

namespace aspic {

std::vector<std::string> linear_solver_names() { return {"auto", "cholesky", "multigrid", "block_jacobi"}; }

std::unique_ptr<LinearSolver> LinearSolver::make_semidefinite_solver() const {
  return std::make_unique<ConjugateGradient>(std::make_unique<BlockJacobi>(BlockJacobi::Blocks::modified));
}

std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name, int solves) {
  if (name == "auto") return std::make_unique<AutoSolver>(std::numeric_limits<int64_t>::max(), solves);
  if (name == "cholesky") return std::make_unique<Cholesky>();
  if (name == "block_jacobi") return std::make_unique<ConjugateGradient>();
  if (name == "multigrid") return std::make_unique<ConjugateGradient>(std::make_unique<Multigrid>());
  throw InvalidInput("no linear solver is called '" + std::string(name) + "'" +
                     suggestion(name, linear_solver_names()));
}

}  // namespace aspic
