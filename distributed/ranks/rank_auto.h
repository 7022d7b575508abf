// Chooses between the linear solvers of several ranks by predicted cost.
#pragma once
#include <memory>
#include <vector>

#include "linalg/linear_solver.h"
#include "ranks/halo.h"

namespace aspic::distributed {

// For each sequence of matrices, block-Jacobi if its predicted iterations are few, else multigrid of each rank with a
// coarse space of all (RankMultigrid), or GAMG on very many ranks. GAMG replaces choices that do not converge. The
// choice is the same on all ranks, and independent of earlier sequences.
class RankAuto : public LinearSolver {
 public:
  // All must outlive this.
  RankAuto(const MeshShare& mesh, const Share& share, Halo& halo) : mesh_(mesh), share_(share), halo_(halo) {}

  std::string_view name() const override { return "auto"; }
  std::string description() const override;
  // Positions of the local vertices at the next begin(), 3 per vertex [m].
  void set_positions(std::span<const double> x) { x_.assign(x.begin(), x.end()); }
  void analyze(const BlockPattern& pattern) override;
  void begin() override;
  bool factorize(const BlockSparse& H) override;
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance) override;
  std::unique_ptr<LinearSolver> make_semidefinite_solver() const override;

 private:
  enum class Choice { none, block_jacobi, multigrid, gamg };
  Choice cheapest(const BlockSparse& H);
  bool factorize_with(Choice choice);

  const MeshShare& mesh_;
  const Share& share_;
  Halo& halo_;
  std::vector<double> x_;
  std::unique_ptr<LinearSolver> solver_;  // only one is in memory
  Choice choice_ = Choice::none;          // of this sequence
  Choice made_ = Choice::none;            // of solver_
  const BlockPattern* pattern_ = nullptr;
  const BlockSparse* H_ = nullptr;
  std::vector<char> scratch_;
};

}  // namespace aspic::distributed
