// The quantities of a material that a fit estimates: Young's modulus, Poisson's ratio and the material's own
// parameters.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "material/registry.h"

namespace aspic {

// young, poisson, MaterialInfo::extra, a component of the direction of fibres among them, and a coordinate of this
// direction in its tangent plane (tangent_frame.h), which replaces the components in a fit.
enum class QuantityRole { stiffness, compressibility, own, component, tilt };

inline constexpr const char* kFibreRatio = "fibre_ratio";
inline constexpr const char* kFibreDirection = "fibre_direction";  // both tilts, in a plan
inline constexpr const char* kFibreTilts[] = {"fibre_tilt_1", "fibre_tilt_2"};

struct Quantity {
  std::string name, unit;  // unit: empty if dimensionless
  QuantityRole role = QuantityRole::own;
  double min = 0, max = 0;  // range
  double typical = 0;       // initial guess inside the range, without other information
  int extra = 0;            // index in MaterialParameters::extra; of a tilt: 0 or 1

  double of(const MaterialParameters& m) const;
};

std::vector<Quantity> material_quantities(const std::string& material);  // stiffness, compressibility, own
Quantity material_quantity(const std::string& material,
                           const std::string& name);  // throws InvalidInput for an unknown name
// Index of the first of three components of the direction of fibres in MaterialParameters::extra; none: isotropic.
std::optional<int> fibre_components(std::string_view material);
bool is_tilt(std::string_view name);
// Returns whether all forces are proportional to the quantity. Its fitted scale is a logarithm.
bool is_stiffness(std::string_view name);

}  // namespace aspic
