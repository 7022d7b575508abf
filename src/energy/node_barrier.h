// The barrier of quadratic tets against inversion at their nodes, for laws that are infinite in inverted elements.
// The quadrature points are inside, so those laws alone let corners and edges invert. With t = J / 0.1,
//   V = sum over tets of volume/10 sum over nodes of -mu/10 (t - 1)^2 log t  for t < 1, else 0
// [Li 2020], which is twice continuously differentiable.
#pragma once
#include <memory>
#include <span>

#include "energy/tet_elasticity.h"

namespace aspic {

// Requires quadratic tets. parameter_count: that of the law, see TetElasticity.
std::unique_ptr<TetElasticity> make_node_barrier(const TetMesh& mesh, int first,
                                                 std::span<const MaterialParameters> parameters, int parameter_count);

}  // namespace aspic
