#include "fit/quantity.h"

#include <algorithm>

#include "base/error.h"

namespace aspic {
namespace {

constexpr char kStiffness[] = "young";

double inside(const ExtraParameter& extra) {
  if (extra.fallback > extra.min && extra.fallback < extra.max) return extra.fallback;
  const double margin = 0.1 * std::min(1.0, extra.max - extra.min);
  return std::clamp(extra.fallback, extra.min + margin, extra.max - margin);
}

}  // namespace

double Quantity::of(const MaterialParameters& m) const {
  if (role == QuantityRole::own) return m.extra[static_cast<size_t>(extra)];
  return role == QuantityRole::stiffness ? young_modulus(m.lame) : poisson_ratio(m.lame);
}

std::vector<Quantity> material_quantities(const std::string& material) {
  std::vector<Quantity> list = {{kStiffness, "Pa", QuantityRole::stiffness, 0, 1e300, 1e5},
                                {"poisson", "", QuantityRole::compressibility, -1, 0.5, 0.4}};
  for (const ExtraParameter& extra : material_info(material).extra)
    list.push_back({extra.name, extra.unit == "1" ? "" : extra.unit, QuantityRole::own, extra.min, extra.max,
                    inside(extra), static_cast<int>(list.size()) - 2});
  return list;
}

Quantity material_quantity(const std::string& material, const std::string& name) {
  std::vector<std::string> known;
  for (Quantity& q : material_quantities(material)) {
    if (q.name == name) return std::move(q);
    known.push_back(q.name);
  }
  throw InvalidInput("'" + name + "' is not a quantity of the model " + material + suggestion(name, known));
}

bool is_stiffness(std::string_view name) { return name == kStiffness; }

}  // namespace aspic
