// Chooses between the linear solvers of several ranks by predicted cost.
#pragma once
#include <memory>
#include <vector>

#include "distributed/petsc_solver.h"
#include "distributed/rank_cg.h"

namespace aspic::distributed {

// For each sequence of matrices, block-Jacobi if its predicted iterations are few, else GAMG, which also replaces
// block-Jacobi if that does not converge. The choice is the same on all ranks, and independent of earlier sequences.
class RankAuto : public LinearSolver {
 public:
  // All must outlive this.
  RankAuto(const MeshShare& mesh, const Share& share, Halo& halo);

  std::string_view name() const override { return "auto"; }
  std::string description() const override;
  void set_positions(std::span<const double> x) { gamg_.set_positions(x); }  // see PetscSolver
  void analyze(const BlockPattern& pattern) override;
  void begin() override;
  bool factorize(const BlockSparse& H) override;
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;
  std::unique_ptr<LinearSolver> make_semidefinite_solver() const override;

 private:
  enum class Choice { none, block_jacobi, gamg };

  const Share& share_;
  Halo& halo_;
  RankCg jacobi_;
  PetscSolver gamg_;
  Choice choice_ = Choice::none;
  const BlockSparse* H_ = nullptr;
  std::vector<char> scratch_;
};

}  // namespace aspic::distributed
