// Coarse space over all ranks: affine displacements of pieces of the mesh, for a preconditioner.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "dynamics/share.h"
#include "linalg/affine_coarsening.h"
#include "linalg/cholesky.h"
#include "ranks/halo.h"

namespace aspic::distributed {

// Each rank divides its own vertices into compact pieces. The matrix P' H P of all pieces is gathered and factorized by
// every rank. Every function is collective.
class CoarseSpace {
 public:
  // All must outlive this.
  CoarseSpace(const MeshShare& mesh, const Share& share, Halo& halo) : mesh_(mesh), share_(share), halo_(halo) {}

  // `own`: the part of `pattern` whose rows and columns are own vertices. Both must outlive this.
  void analyze(const BlockPattern& pattern, const BlockPattern& own);
  bool factorize(const BlockSparse& H);                                 // false: not positive definite
  void add_correction(std::span<const double> r, std::span<double> z);  // z += P (P' H P)^-1 P' r in own rows

 private:
  void build();
  Aggregates pieces_of_own_vertices() const;
  Aggregates number_pieces(const std::vector<int>& piece_of_own);
  void take_weights_of_ghosts();
  void keep_own_rows();
  void gather_pattern();
  std::span<const int> rows_of_own(int piece) const { return local_.rows_of(first_local_ + piece); }

  const MeshShare& mesh_;
  const Share& share_;
  Halo& halo_;
  const BlockPattern* pattern_ = nullptr;
  const BlockPattern* own_ = nullptr;
  std::vector<char> isolated_;  // own rows without couplings (pinned)
  bool is_built_ = false;
  int first_ = 0, own_pieces_ = 0;  // numbers of the own pieces among those of all ranks
  std::vector<int> number_;         // number of each local piece, ascending: own ones and those of ghosts
  int first_local_ = 0;             // first own piece among the local ones
  AffineCoarsening local_;          // of the local pieces; only own ones have rows
  MatrixRestriction restriction_;
  std::unique_ptr<BlockSparse> local_matrix_;
  BlockPattern coarse_pattern_;  // of all pieces, four rows each
  std::unique_ptr<BlockSparse> coarse_matrix_;
  Cholesky cholesky_;
  std::vector<int> counts_, starts_;  // entries of each rank in a coarse vector
  std::vector<double> own_b_, b_, x_;
};

}  // namespace aspic::distributed
