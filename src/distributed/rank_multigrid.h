// Preconditioner over the ranks: multigrid for the own vertices of each rank, and a coarse space over all of them.
#pragma once
#include <span>

#include "distributed/coarse_space.h"
#include "linalg/approximate_inverse.h"
#include "linalg/multigrid.h"

namespace aspic::distributed {

// Additive Schwarz method without overlap. One rank has multigrid alone. Vectors have 3 entries per local vertex; those
// of ghosts are neither read nor written. Every function is collective.
class RankMultigrid : public ApproximateInverse {
 public:
  // All must outlive this.
  RankMultigrid(const MeshShare& mesh, const Share& share, Halo& halo)
      : mesh_(mesh), share_(share), coarse_(mesh, share, halo) {}

  std::string_view name() const override { return "multigrid"; }
  std::string description() const override;
  void analyze(const BlockPattern& pattern) override;
  bool factorize(const BlockSparse& H) override;
  void apply(std::span<const double> r, std::span<double> z) override;
  bool is_multigrid() const override { return true; }

 private:
  bool has_coarse_space() const { return mesh_.ranks() > 1; }

  const MeshShare& mesh_;
  const Share& share_;
  BlockPattern own_pattern_;
  Multigrid own_;
  CoarseSpace coarse_;
};

}  // namespace aspic::distributed
