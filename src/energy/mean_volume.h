// Nearly incompressible solids of quadratic tets. A part of the bulk modulus acts on the mean J of each tet only, which
// avoids locking [Simo, Taylor and Pister 1985; weakly penalized as in Hadjicharalambous et al. 2014]:
//   V = sum over tets of int psi(F; mu, la_pt) dX + volume (la - la_pt)/2 (mean J - 1)^2,   la_pt = min(la, 3/2 mu)
// The moduli of small strains are those of psi(F; mu, la). The remaining pointwise part, with Poisson's ratio 0.3, is
// needed: the mean leaves three modes per tet without energy. The energy is continuous in Poisson's ratio.
#pragma once
#include <memory>
#include <span>

#include "energy/tet_elasticity.h"

namespace aspic {

// Requires quadratic tets. Which tets are split depends on their current parameters, so that Poisson's ratio may cross
// 0.3. `make_shape`: makes the first term for other parameters. `has_barrier`: adds node_barrier.h.
std::unique_ptr<TetElasticity> make_mean_volume(const ElasticityMaker& make_shape, const TetMesh& mesh, int first,
                                                std::span<const MaterialParameters> parameters, bool has_barrier);

}  // namespace aspic
