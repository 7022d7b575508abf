// Conjugate gradients over the ranks, with block-Jacobi or multigrid.
#pragma once
#include <memory>
#include <vector>

#include "linalg/approximate_inverse.h"
#include "linalg/linear_solver.h"
#include "ranks/halo.h"
#include "ranks/rank_multigrid.h"

namespace aspic::distributed {

// Rows of the own vertices are complete in every matrix; those of ghosts are ignored.
class RankCg : public LinearSolver {
 public:
  // With block-Jacobi. Blocks of the diagonal that are not positive definite are modified, so that the iteration
  // detects negative curvature. Both must outlive this.
  RankCg(const Share& share, Halo& halo, int max_iterations = 10'000);
  RankCg(const Share& share, Halo& halo, std::unique_ptr<RankMultigrid> multigrid, int max_iterations);

  std::string_view name() const override { return preconditioner_->name(); }
  std::string description() const override { return "conjugate gradients with " + preconditioner_->description(); }
  void analyze(const BlockPattern& pattern) override;
  void begin() override { is_made_ = false; }
  // Multigrid is reused for the matrices of a sequence until the iterations per digit have grown by 30 %.
  bool factorize(const BlockSparse& H) override;
  // If the iteration detects negative curvature, x is the last iterate (at the first iteration: the preconditioned b).
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;
  std::unique_ptr<LinearSolver> make_semidefinite_solver() const override;

 private:
  double dot(std::span<const double> a, std::span<const double> b) const;
  bool start(std::span<const double> b, std::span<double> x);  // sets x and r; false: to 0 and b
  void precondition();                                         // z = M^-1 r
  // Advances x along p. Returns the length of the step, or 0 if the curvature is not positive.
  double advance(std::span<double> x, double rz, SolveReport& report);
  void turn(double alpha, double& rz);  // sets the next p, and r'z
  void note_rate(const SolveReport& report);

  const Share& share_;
  Halo& halo_;
  int max_iterations_;
  std::unique_ptr<ApproximateInverse> preconditioner_;
  RankMultigrid* multigrid_ = nullptr;  // preconditioner_, or null with block-Jacobi
  bool is_made_ = false;                // the preconditioner, for this matrix or an earlier one
  // Iterations per digit of the first and the last solve with this preconditioner; 0: none.
  double first_rate_ = 0, rate_ = 0;
  const BlockSparse* H_ = nullptr;
  int own_ = 0;
  std::vector<double> r_, z_, p_, q_;
};

}  // namespace aspic::distributed
