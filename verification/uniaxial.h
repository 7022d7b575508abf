// A bar that is pulled with free sides.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "material/registry.h"

namespace aspic::verify {

struct Uniaxial {
  double lateral;  // stretch t across the bar [1]
  double stress;   // nominal stress P along it [Pa]
};

struct UniaxialReference {
  const char* material;
  double poisson, stretch;
  Uniaxial expected;
};
// Young's modulus 1 Pa; computed independently of this library and printed to 8 decimals.
const std::vector<UniaxialReference>& uniaxial_table();

// A distorted box of linear tets, its vertices where an affine map with the stretch l puts them; t near `guess` such
// that no force is left on the sides. Throws std::runtime_error when there is none.
struct StretchedBox : Uniaxial {
  double inner_force;  // the largest at a vertex that is held by nothing, over the force of the pull
};
StretchedBox stretched_box(const std::string& material, const MaterialParameters& parameters, double l, double guess);

// Returns reference_energy() of the material at principal stretches, for its default extra parameters [J/m^3].
long double principal_energy(const std::string& material, const std::array<long double, 3>& stretch, double young,
                             double poisson);
// The uniaxial state by differences of principal_energy, to about 1e-14.
Uniaxial uniaxial_of_energy(const std::string& material, double young, double poisson, double l);

}  // namespace aspic::verify
