#include "energy/node_barrier.h"

#include "energy/node_barrier_law.h"

namespace aspic {

std::unique_ptr<TetElasticity> make_node_barrier(const TetMesh& mesh, int first,
                                                 std::span<const MaterialParameters> parameters, int parameter_count) {
  return std::make_unique<NodeBarrier>("nodes", mesh, first, parameters,
                                       FromInvariants<NodeBarrierLaw>{{.extra = parameter_count - 2}});
}

}  // namespace aspic
