// The quantities of a material that a fit estimates: Young's modulus, Poisson's ratio and the material's own
// parameters.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "material/registry.h"

namespace aspic {

enum class QuantityRole { stiffness, compressibility, own };  // young, poisson, MaterialInfo::extra

struct Quantity {
  std::string name, unit;  // unit: empty if dimensionless
  QuantityRole role = QuantityRole::own;
  double min = 0, max = 0;  // range
  double typical = 0;       // initial guess inside the range, without other information
  int extra = 0;            // index in MaterialParameters::extra

  double of(const MaterialParameters& m) const;
};

std::vector<Quantity> material_quantities(const std::string& material);  // stiffness, compressibility, own
Quantity material_quantity(const std::string& material,
                           const std::string& name);  // throws InvalidInput for an unknown name
// Returns whether all forces are proportional to the quantity. Its fitted scale is a logarithm.
bool is_stiffness(std::string_view name);

}  // namespace aspic
