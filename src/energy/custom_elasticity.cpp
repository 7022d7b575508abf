#include "energy/custom_elasticity.h"

#include "energy/custom_material.h"
#include "energy/material_term.h"
#include "energy/quadratic_batch.h"

namespace aspic {
ElasticityMaker custom_material(std::string name, int extra, std::shared_ptr<const CustomDensity> density) {
  return [=](const TetMesh& mesh, int first, std::span<const MaterialParameters> parameters) {
    const CustomMaterial material{density, extra};
    if (!parameters.empty() && is_quadratic(mesh, first))
      return std::unique_ptr<TetElasticity>(
          std::make_unique<MaterialTerm<CustomMaterial, QuadraticTetBatch>>(name, mesh, first, parameters, material));
    return std::unique_ptr<TetElasticity>(
        std::make_unique<MaterialTerm<CustomMaterial, TetBatch>>(name, mesh, first, parameters, material));
  };
}

}  // namespace aspic
