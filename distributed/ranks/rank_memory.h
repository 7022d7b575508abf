// Memory of a rank, predicted before it is allocated.
#pragma once
#include <string>

namespace aspic::distributed {

struct MemoryNeed {
  double vertices = 0;  // of the whole mesh
  int ranks = 1;
  bool has_multigrid = true;  // a kind of multigrid; else block-Jacobi
};
// Upper estimate for the process of a rank [bytes].
double bytes_per_rank(const MemoryNeed& need);

// Throws InvalidInput with a remedy if the ranks on this machine would need more than `available` bytes.
void require_memory(const MemoryNeed& need, int ranks_here, double available);

// Number of ranks on the machine of this process. Collective.
int ranks_on_this_machine();

}  // namespace aspic::distributed
