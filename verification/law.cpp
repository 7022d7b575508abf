#include "verification/law.h"

#include <map>

#include "material/list.h"
#include "verification/uniaxial.h"

namespace aspic::verify {
namespace {

template <class M>
Law make_law() {
  return {
      M::info(),
      [](const Mat3d& F) { return M::psi(F, ordinary_params<M>()); },
      [](const Mat3d& F) { return M::pk1(F, ordinary_params<M>()); },
      [](const Mat3d& F) { return M::hessian(F, ordinary_params<M>()); },
      [](const Mat3d& F) { return M::psi(jet_variables(F), broadcast_params<M, Jet<double>>(ordinary_params<M>())); },
      M::reference_energy,
      smooth_states<M>()};
}

}  // namespace

const Law& law(const std::string& material) {
  static const std::map<std::string, Law> laws = [] {
    std::map<std::string, Law> all;
    for_each_material([&all]<class M>() { all.emplace(M::info().name, make_law<M>()); });
    return all;
  }();
  return laws.at(material_info(material).name);
}

long double principal_energy(const std::string& material, const std::array<long double, 3>& stretch, double young,
                             double poisson) {
  return law(material).reference(PrincipalStretches(stretch), {young, poisson});
}

}  // namespace aspic::verify
