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

// `local`: a load whose gradient does not depend on x, as on one rank, so that it is wrong at ghosts. `own_entries`: 3
// times the number of own vertices.
std::unique_ptr<Energy> make_shared_load(std::unique_ptr<Energy> local, int own_entries, const Share& share);

// `local`: damping of the tets of this rank, a quadratic form of the motion x - start, so that D is half its product
// with the gradient. `own_entries` as above.
std::unique_ptr<Energy> make_shared_damping(std::unique_ptr<Energy> local, int own_entries, const Share& share);

}  // namespace aspic::distributed
