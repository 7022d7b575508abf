#include "data/units.h"

#include <numbers>

#include "base/check.h"

namespace aspic {
namespace {

struct Unit {
  const char* quantity;
  const char* name;
  double in_si;
};

constexpr Unit kUnits[] = {
    {"length", "m", 1},
    {"length", "cm", 1e-2},
    {"length", "mm", 1e-3},
    {"length", "um", 1e-6},
    {"length", "in", 0.0254},
    {"force", "N", 1},
    {"force", "mN", 1e-3},
    {"force", "kN", 1e3},
    {"force", "g", 1e-3 * kStandardGravity},
    {"force", "kg", kStandardGravity},
    {"force", "lbf", 0.45359237 * kStandardGravity},
    {"torque", "N m", 1},
    {"torque", "N cm", 1e-2},
    {"torque", "N mm", 1e-3},
    {"torque", "mN m", 1e-3},
    {"angle", "rad", 1},
    {"angle", "deg", std::numbers::pi / 180},
    {"pressure", "Pa", 1},
    {"pressure", "hPa", 1e2},
    {"pressure", "kPa", 1e3},
    {"pressure", "MPa", 1e6},
    {"pressure", "bar", 1e5},
    {"pressure", "mbar", 1e2},
    {"pressure", "mmHg", 133.322387415},
    {"pressure", "psi", 6894.757293168361},
    {"gravity", "m/s^2", 1},
    {"gravity", "g", kStandardGravity},
};

std::string_view kind_of(std::string_view quantity) {
  return quantity == "mesh" || quantity == "recording" ? "length" : quantity;
}

}  // namespace

std::vector<std::string> unit_names(std::string_view quantity) {
  std::vector<std::string> names;
  for (const Unit& unit : kUnits)
    if (unit.quantity == kind_of(quantity)) names.emplace_back(unit.name);
  return names;
}

double unit_in_si(std::string_view quantity, std::string_view unit) {
  for (const Unit& u : kUnits)
    if (u.quantity == kind_of(quantity) && u.name == unit) return u.in_si;
  ASPIC_CHECK(false);
  return 1;
}

}  // namespace aspic
