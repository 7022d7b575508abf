// Units of measured data.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

// Units of "length", "mesh", "force", "torque", "angle", "pressure" or "gravity"; the SI unit is first.
std::vector<std::string> unit_names(std::string_view quantity);
double unit_in_si(std::string_view quantity, std::string_view unit);  // requires a name of that list

}  // namespace aspic
