// Systems H x = b one after another whose matrices and solutions change little, as those of time steps: each starts
// from the best combination of the last solutions, and a factor serves the next matrices as the preconditioner of
// conjugate gradients.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "linalg/conjugate_gradient.h"

namespace aspic {

struct SequenceReport {
  SolveReport solve;
  bool factorized = false;  // or a preconditioner was made
};

class SequenceSolver {
 public:
  // `linear` names the solver, see linear_solver_names(). |b - H x| <= tolerance |b|.
  SequenceSolver(const std::string& linear, double tolerance);

  void begin();  // another sequence; nothing is known of its solutions and matrices
  SequenceReport solve(const BlockSparse& H, std::span<const double> b, std::span<double> x);
  std::string description() const { return solver_->description(); }

 private:
  using Vector = std::vector<double>;
  // x = the combination of the remembered solutions that is closest to H^-1 b in the norm of H.
  void project(const BlockSparse& H, std::span<const double> b, std::span<double> x);
  void remember(std::span<const double> x);
  // H x = b with the factor of a matrix before. False: there is none, or it is better made anew.
  bool solve_with_factor(const BlockSparse& H, std::span<const double> b, std::span<double> x, double tolerance,
                         SolveReport& report);
  void note(const SolveReport& report, double tolerance);  // what the factor was good for
  bool is_worn() const;

  std::unique_ptr<LinearSolver> solver_;
  ConjugateGradient by_factor_;  // preconditioned with that of solver_
  double tolerance_;
  uint64_t analyzed_version_ = 0;
  // Of the factor at hand: substitutions that it has cost so far, digits that were solved with it, and substitutions
  // for a digit at the last solve. No digits: there is no factor.
  double spent_ = 0, digits_ = 0, rate_ = 0;
  std::vector<Vector> last_;           // solutions, latest first
  std::vector<Vector> basis_, image_;  // scratch: the same made H-orthonormal, and H times that
  Vector residual_, rest_;             // scratch
};

}  // namespace aspic
