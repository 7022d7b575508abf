// Preconditioner over the ranks: multigrid for the own vertices of each rank, and a coarse space over all of them.
#pragma once
#include <span>
#include <vector>

#include "linalg/approximate_inverse.h"
#include "linalg/multigrid.h"
#include "ranks/coarse_space.h"

namespace aspic::distributed {

// M^-1 = (I - Q H) B + Q, where B is the multigrid of the ranks, and Q = P (P' H P)^-1 P' the correction by the coarse
// space. If conjugate gradients start from Q b, P' r = 0 holds from then on, and M^-1 acts like the symmetric
// (I - Q H) B (I - H Q) + Q, with fewer products [Tang, Nabben, Vuik and Erlangga 2009, A-DEF2]. One rank has
// multigrid alone. Vectors have 3 entries per local vertex; those of ghosts are overwritten. Every function is
// collective.
class RankMultigrid : public ApproximateInverse {
 public:
  // All must outlive this.
  RankMultigrid(const MeshShare& mesh, const Share& share, Halo& halo)
      : mesh_(mesh), share_(share), halo_(halo), coarse_(mesh, share, halo) {}

  std::string_view name() const override { return "multigrid"; }
  std::string description() const override;
  void analyze(const BlockPattern& pattern) override;
  bool factorize(const BlockSparse& H) override;               // H must outlive this, or be replaced by follow()
  bool follow(const BlockSparse& H);                           // keeps B, and renews Q
  bool start(std::span<const double> b, std::span<double> x);  // x = Q b; false: there is no coarse space
  void apply(std::span<const double> r, std::span<double> z) override;

 private:
  bool has_coarse_space() const { return mesh_.ranks() > 1; }

  const MeshShare& mesh_;
  const Share& share_;
  Halo& halo_;
  const BlockSparse* H_ = nullptr;
  BlockPattern own_pattern_;
  Multigrid own_;
  CoarseSpace coarse_;
  std::vector<double> residual_;
};

}  // namespace aspic::distributed
