#include "model/quantity.h"

#include <algorithm>

#include "base/error.h"

namespace aspic {
namespace {

constexpr char kStiffness[] = "young", kFirstComponent[] = "fibre_x";
constexpr double kAnyTilt = 1e300;  // no limit; twice as much is finite

double inside(const ExtraParameter& extra) {
  if (extra.fallback > extra.min && extra.fallback < extra.max) return extra.fallback;
  const double margin = 0.1 * std::min(1.0, extra.max - extra.min);
  return std::clamp(extra.fallback, extra.min + margin, extra.max - margin);
}

}  // namespace

double Quantity::of(const MaterialParameters& m) const {
  if (role == QuantityRole::own || role == QuantityRole::component) return m.extra[static_cast<size_t>(extra)];
  return role == QuantityRole::stiffness ? young_modulus(m.lame) : poisson_ratio(m.lame);
}

std::vector<Quantity> material_quantities(const std::string& material) {
  std::vector<Quantity> list = {{kStiffness, "Pa", QuantityRole::stiffness, 0, 1e300, 1e5},
                                {"poisson", "", QuantityRole::compressibility, -1, 0.5, 0.4}};
  for (const ExtraParameter& extra : material_info(material).extra)
    list.push_back({extra.name, extra.unit == "1" ? "" : extra.unit, QuantityRole::own, extra.min, extra.max,
                    extra.name == kFibreRatio ? 1 : inside(extra), static_cast<int>(list.size()) - 2});
  if (const std::optional<int> first = fibre_components(material))
    for (int r = 0; r < 3; ++r) list[2 + *first + r].role = QuantityRole::component;
  return list;
}

Quantity material_quantity(const std::string& material, const std::string& name) {
  std::vector<std::string> known;
  for (Quantity& q : material_quantities(material)) {
    if (q.name == name) return std::move(q);
    known.push_back(q.name);
  }
  const bool has_fibres = fibre_components(material).has_value();
  for (int k = 0; k < 2; ++k)
    if (has_fibres && name == kFibreTilts[k]) return {name, "", QuantityRole::tilt, -kAnyTilt, kAnyTilt, 0, k};
  if (!has_fibres && name == kFibreDirection)
    throw InvalidInput("'" + name + "': the model " + material +
                       " is isotropic; use --model neo_hookean_fibres, whose fibres have a direction");
  if (has_fibres) known.emplace_back(kFibreDirection);
  throw InvalidInput("'" + name + "' is not a quantity of the model " + material + suggestion(name, known));
}

std::optional<int> fibre_components(std::string_view material) {
  const MaterialInfo& info = material_info(material);
  for (size_t k = 0; k < info.extra.size(); ++k)
    if (info.extra[k].name == kFirstComponent) return static_cast<int>(k);
  return {};
}

bool is_tilt(std::string_view name) { return name == kFibreTilts[0] || name == kFibreTilts[1]; }

bool is_stiffness(std::string_view name) { return name == kStiffness; }

}  // namespace aspic
