// Conjugate gradients over the ranks, with block-Jacobi.
#pragma once
#include <vector>

#include "distributed/halo.h"
#include "linalg/block_jacobi.h"
#include "linalg/linear_solver.h"

namespace aspic::distributed {

// Rows of the own vertices are complete in every matrix; those of ghosts are ignored. Blocks of the diagonal that are
// not positive definite are modified, so that the iteration detects negative curvature.
class RankCg : public LinearSolver {
 public:
  // Both must outlive this.
  RankCg(const Share& share, Halo& halo, int max_iterations = 10'000)
      : share_(share), halo_(halo), max_iterations_(max_iterations) {}

  std::string_view name() const override { return "block_jacobi"; }
  std::string description() const override { return "conjugate gradients with block_jacobi"; }
  void analyze(const BlockPattern& pattern) override;
  bool factorize(const BlockSparse& H) override;
  // If the iteration detects negative curvature, x is the last iterate (at the first iteration: the preconditioned b).
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;
  std::unique_ptr<LinearSolver> make_semidefinite_solver() const override;

 private:
  double dot(std::span<const double> a, std::span<const double> b) const;
  void precondition();  // z = M^-1 r
  // Advances x along p. Returns false if the curvature is not positive.
  bool advance(std::span<double> x, double rz, SolveReport& report);

  const Share& share_;
  Halo& halo_;
  int max_iterations_;
  BlockJacobi jacobi_{BlockJacobi::Blocks::modified};
  const BlockSparse* H_ = nullptr;
  int own_ = 0;
  std::vector<double> r_, z_, p_, q_;
};

}  // namespace aspic::distributed
