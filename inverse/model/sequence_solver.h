// Solves a sequence of systems H x = b with slowly changing matrices and solutions, such as time steps. Each solve
// starts from the best combination of previous solutions; a factor preconditions conjugate gradients for subsequent
// matrices.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "linalg/conjugate_gradient.h"

namespace aspic {

struct SequenceReport {
  SolveReport solve;
  bool factorized = false;  // or a preconditioner was computed
};

class SequenceSolver {
 public:
  // `linear` names the solver, see linear_solver_names(). |b - H x| <= tolerance |b|.
  SequenceSolver(const std::string& linear, double tolerance);

  void begin();  // starts another sequence and clears solutions and matrices
  SequenceReport solve(const BlockSparse& H, std::span<const double> b, std::span<double> x);
  std::string description() const { return solver_->description(); }

 private:
  using Vector = std::vector<double>;
  // x = combination of the stored solutions that is closest to H^-1 b in the norm of H.
  void project(const BlockSparse& H, std::span<const double> b, std::span<double> x);
  void remember(std::span<const double> x);
  // Solves H x = b with the factor of a previous matrix. Returns false if there is none, or a new one is better.
  bool solve_with_factor(const BlockSparse& H, std::span<const double> b, std::span<double> x, double tolerance,
                         SolveReport& report);
  void note(const SolveReport& report, double tolerance);  // records the efficiency of the factor
  bool is_worn() const;

  std::unique_ptr<LinearSolver> solver_;
  ConjugateGradient by_factor_;  // preconditioned by the factor of solver_
  double tolerance_;
  uint64_t analyzed_version_ = 0;
  // Statistics of the current factor: total substitutions, solved digits, and substitutions per digit of the last
  // solve. No digits: no factor.
  double spent_ = 0, digits_ = 0, rate_ = 0;
  std::vector<Vector> last_;           // newest first
  std::vector<Vector> basis_, image_;  // scratch: H-orthonormal basis, and H times it
  Vector residual_, rest_;             // scratch
};

}  // namespace aspic
