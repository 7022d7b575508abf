// The parts of a distributed model, see dynamics/stiffness_parts.h.
#pragma once
#include <span>
#include <vector>

#include "ranks/halo.h"

namespace aspic::distributed {

// Returns parts_of() of the whole mesh for the local vertices. `modulus`: of the own vertices [Pa]. Collective.
std::vector<int> parts_of_ranks(const TetMesh& local, const MeshShare& share, Halo& halo,
                                std::span<const double> modulus);

}  // namespace aspic::distributed
