#include <map>

#include "material/list.h"
#include "material/reference.h"
#include "material/registry.h"
#include "reference/uniaxial.h"

namespace aspic::verify {

using EnergyOfStretches = long double (*)(const PrincipalStretches& s, const ReferenceModuli& m);

long double principal_energy(const std::string& material, const std::array<long double, 3>& stretch, double young,
                             double poisson) {
  static const std::map<std::string, EnergyOfStretches> energies = [] {
    std::map<std::string, EnergyOfStretches> all;
    for_each_material([&all]<class M>() { all.emplace(M::info().name, M::reference_energy); });
    return all;
  }();
  return energies.at(material_info(material).name)(PrincipalStretches(stretch), {young, poisson});
}

}  // namespace aspic::verify
