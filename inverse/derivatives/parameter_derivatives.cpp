#include "derivatives/parameter_derivatives.h"

#include <string>

#include "base/error.h"
#include "derivatives/mean_volume_derivatives.h"
#include "derivatives/of_material.h"
#include "energy/custom_material.h"
#include "energy/node_barrier_law.h"
#include "energy/quadratic_batch.h"
#include "material/all_materials.h"

namespace aspic {
namespace {

using Found = std::unique_ptr<ParameterDerivatives>;

// Each material is instantiated in a generated file of its own, see CMakeLists.txt.
template <class M>
Found of_material(const TetElasticity& term) {
  Found found = derivatives_of_material<M, TetBatch>(term);
  return found ? std::move(found) : derivatives_of_material<M, QuadraticTetBatch>(term);
}

template <class... Materials>
Found of_any(const TetElasticity& term, const std::tuple<Materials...>*) {
  Found found;
  (void)((found = of_material<Materials>(term)) || ...);
  return found;
}

}  // namespace

std::unique_ptr<ParameterDerivatives> derivatives_of(const TetElasticity& term) {
  if (Found found = of_any(term, static_cast<const MaterialList*>(nullptr))) return found;
  if (Found found = of_material<CustomMaterial>(term)) return found;
  if (Found found = derivatives_of_material<FromInvariants<NodeBarrierLaw>, QuadraticNodeBatch>(term)) return found;
  if (Found found = mean_volume_derivatives(term)) return found;
  throw InvalidInput("the energy '" + std::string(term.name()) + "' has no derivatives with respect to its parameters");
}

}  // namespace aspic
