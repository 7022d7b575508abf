// Instances for what is no material of the list: user-defined ones and the barrier at nodes.
#include "derivatives/material_derivatives.h"
#include "energy/custom_material.h"
#include "energy/node_barrier_law.h"
#include "energy/quadratic_batch.h"

namespace aspic {

using Found = std::unique_ptr<ParameterDerivatives>;
template Found derivatives_of_material<CustomMaterial, TetBatch>(const TetElasticity&);
template Found derivatives_of_material<CustomMaterial, QuadraticTetBatch>(const TetElasticity&);
template Found derivatives_of_material<FromInvariants<NodeBarrierLaw>, QuadraticNodeBatch>(const TetElasticity&);

}  // namespace aspic
