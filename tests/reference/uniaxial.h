// Uniaxial stress with free sides.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "material/registry.h"

namespace aspic::verify {

struct Uniaxial {
  double lateral;  // lateral stretch t [1]
  double stress;   // nominal stress P along the bar [Pa]
};

struct UniaxialReference {
  const char* material;
  double poisson, stretch;
  Uniaxial expected;
};
// Table for Young's modulus 1 Pa; computed independently of this library and printed to 8 decimals.
const std::vector<UniaxialReference>& uniaxial_table();

// A distorted box of linear tets with vertices at an affine map with stretch l, and t near `guess` such that the sides
// are free of force. Throws std::runtime_error if there is none.
struct StretchedBox : Uniaxial {
  double inner_force;  // largest force at a free inner vertex, over the pulling force
};
StretchedBox stretched_box(const std::string& material, const MaterialParameters& parameters, double l, double guess);

// Returns reference_energy() of the material at principal stretches, for its default extra parameters [J/m^3].
long double principal_energy(const std::string& material, const std::array<long double, 3>& stretch, double young,
                             double poisson);
// Uniaxial state by differences of principal_energy, accurate to about 1e-14.
Uniaxial uniaxial_of_energy(const std::string& material, double young, double poisson, double l);

}  // namespace aspic::verify
