// The part of a model that one rank simulates.
#pragma once
#include <string>
#include <vector>

#include "distributed/mpi_ranks.h"

namespace aspic::distributed {

// Returns a model of the local vertices and tets. `whole` has linear tets of the `materials`, one per body, and loads
// with constant gradients. `ranks` must outlive the result.
Model share_model(const Model& whole, const std::vector<std::string>& materials, const MeshShare& share,
                  const MpiRanks& ranks);

}  // namespace aspic::distributed
