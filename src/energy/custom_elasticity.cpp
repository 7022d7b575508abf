#include "energy/custom_elasticity.h"

#include "energy/material_term.h"
#include "energy/quadratic_batch.h"

namespace aspic {
namespace {

struct CustomMaterial {
  template <class T>
  using Params = MaterialParametersOver<T>;

  std::shared_ptr<const CustomDensity> density;
  int extra;  // number of used entries of MaterialParameters::extra

  template <class T>
  static Params<T> params(const Params<T>& p) {
    return p;
  }
  Pack psi(const Mat3<Pack>& F, const Params<Pack>& p) const { return density->psi(F, p); }
  template <class T>
  Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) const {
    return density->pk1(F, p);
  }
  Mat9<Pack> hessian(const Mat3<Pack>& F, const Params<Pack>& p) const { return density->hessian(F, p); }
};

}  // namespace

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
