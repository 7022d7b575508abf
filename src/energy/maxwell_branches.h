// Viscoelasticity: Maxwell branches beside the elasticity of a body [Simo 1987]. The stress of a branch obeys
//   s' + s / tau = 2 G E',  E = (F'F - I) / 2,
// so it is rotation invariant and decays with the relaxation time tau. A step in which strains are linear in time
// minimizes, besides V,
//   D(x) = sum volume (G phi |E - E_0|^2 + exp(-duration/tau) s_0 : (E - E_0))  over all branches (maxwell_factors.h).
// Short relaxation times give strain-rate damping of the viscosity 2 G tau.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

struct MaxwellBranch {
  std::vector<double> shear;   // G of each tet [Pa], >= 0
  double relaxation_time = 1;  // tau [s], > 0
};

// Returns all branches of the tets from `first`, at least one. The term implements InternalVariables: six stresses xx
// yy zz xy yz zx [Pa] per tet, quadrature point and branch.
std::unique_ptr<Energy> make_maxwell_branches(std::string name, const TetMesh& mesh, int first,
                                              std::vector<MaxwellBranch> branches);

}  // namespace aspic
