// Communication of a distributed model by MPI.
#pragma once
#include "distributed/mesh_share.h"

namespace aspic::distributed {

class MpiRanks : public Ranks {
 public:
  // Both must outlive the calls of parts().
  MpiRanks(const TetMesh& whole, const MeshShare& share) : whole_(whole), share_(share) {}
  std::vector<double> gather(std::span<const double> own) const override;
  std::vector<int> parts(std::span<const double> modulus) const override;

 private:
  const TetMesh& whole_;
  const MeshShare& share_;
};

int rank_of_this_process();
int rank_count();
// Returns the largest value of all ranks. Collective.
int largest_of_ranks(int own);
// Returns the values of the own vertices of all ranks in the order of the whole mesh, `components` per vertex, on rank
// 0; nothing on other ranks. Collective.
std::vector<double> gather_vertices(const MeshShare& share, std::span<const double> local, int components = 3);
// Copies the values of rank 0 to all ranks. `values` has the same size on all of them. Collective.
void broadcast(std::span<double> values);

}  // namespace aspic::distributed
