// Matrices and vectors of the core as those of PETSc.
#pragma once
#include <petscksp.h>

#include <cstdint>
#include <span>
#include <vector>

#include "linalg/block_sparse.h"
#include "ranks/mesh_share.h"

namespace aspic::distributed {

void check(PetscErrorCode error);  // throws std::runtime_error with the text of PETSc

void copy_to(std::span<const double> own, Vec v);  // sizes are equal
void copy_from(Vec v, std::span<double> own);

// The rows of the own vertices of a matrix, with both triangles.
class RowsOfRank {
 public:
  RowsOfRank() = default;
  RowsOfRank(const MeshShare& mesh, const BlockPattern& pattern);  // `mesh` must outlive this

  Mat make_matrix() const;                       // of these rows of all ranks, without values. Collective
  void fill(const BlockSparse& H, Mat A) const;  // copies the values. Collective

 private:
  struct Entry {
    PetscInt column;  // in the whole mesh
    std::int64_t slot;
    bool is_transposed;
  };

  const MeshShare* mesh_ = nullptr;
  std::vector<size_t> start_;  // of each row in entry_
  std::vector<Entry> entry_;   // columns ascend
};

// Makes orthonormal rigid motions of the positions of the local vertices, 3 per vertex [m], the near-null space of A.
// `like`: a vector of A. Collective.
void set_rigid_motions(const MeshShare& mesh, std::span<const double> positions, Vec like, Mat A);

}  // namespace aspic::distributed
