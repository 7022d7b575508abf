// Communication of a distributed model by MPI.
#pragma once
#include "ranks/halo.h"

namespace aspic::distributed {

class MpiRanks : public Ranks {
 public:
  // Both must outlive this.
  MpiRanks(const MeshShare& share, Halo& halo) : share_(share), halo_(halo) {}
  std::vector<double> gather(std::span<const double> own) const override;
  std::vector<int> parts(const TetMesh& mesh, std::span<const double> modulus) const override;

 private:
  const MeshShare& share_;
  Halo& halo_;
};

int rank_of_this_process();
int rank_count();
// Returns the largest value of all ranks. Collective.
int largest_of_ranks(int own);
// Copies the values of rank 0 to all ranks. `values` has the same size on all of them. Collective.
void broadcast(std::span<double> values);

}  // namespace aspic::distributed
