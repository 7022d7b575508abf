// Units of measured data.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

inline constexpr double kStandardGravity = 9.80665;  // by definition [m/s^2]; scales convert forces to masses with it

// Units of "length", "mesh", "force", "torque", "angle", "pressure" or "gravity"; the SI unit is first.
std::vector<std::string> unit_names(std::string_view quantity);
double unit_in_si(std::string_view quantity, std::string_view unit);  // requires a name of that list

}  // namespace aspic
