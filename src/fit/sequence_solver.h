// Systems H x = b one after another whose matrices and solutions change little, as those of time steps: each starts
// from the best combination of the last solutions.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "linalg/linear_solver.h"

namespace aspic {

class SequenceSolver {
 public:
  // `linear` names the solver, see linear_solver_names(). |b - H x| <= tolerance |b|.
  SequenceSolver(const std::string& linear, double tolerance)
      : solver_(make_linear_solver(linear)), tolerance_(tolerance) {}

  void begin();  // another sequence; nothing is known of its solutions
  SolveReport solve(const BlockSparse& H, std::span<const double> b, std::span<double> x);

 private:
  using Vector = std::vector<double>;
  // x = the combination of the remembered solutions that is closest to H^-1 b in the norm of H.
  void project(const BlockSparse& H, std::span<const double> b, std::span<double> x);
  void remember(std::span<const double> x);

  std::unique_ptr<LinearSolver> solver_;
  double tolerance_;
  uint64_t analyzed_version_ = 0;
  std::vector<Vector> last_;           // solutions, latest first
  std::vector<Vector> basis_, image_;  // scratch: the same made H-orthonormal, and H times that
  Vector residual_, rest_;             // scratch
};

}  // namespace aspic
