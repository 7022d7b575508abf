// Terms of V whose values are those of the whole model, while gradients and Hessians are those of one rank.
#pragma once
#include <memory>

#include "dynamics/share.h"
#include "energy/tet_elasticity.h"

namespace aspic::distributed {

// `counted`: the tets whose energy this rank counts; `halo`: the other tets at its vertices.
struct ElasticityOfRank {
  std::unique_ptr<TetElasticity> counted, halo;
};
std::unique_ptr<TetElasticity> make_shared_elasticity(ElasticityOfRank parts, const Share& share);

// `own`: a load without energy and forces at the ghosts.
std::unique_ptr<Energy> make_shared_load(std::unique_ptr<Energy> own, const Share& share);

}  // namespace aspic::distributed
