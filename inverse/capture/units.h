// Units of measurement in which data may be given.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

// Of "length", "mesh", "force", "torque", "angle", "pressure" or "gravity"; the first is that of the SI.
std::vector<std::string> unit_names(std::string_view quantity);
double unit_in_si(std::string_view quantity, std::string_view unit);  // of a name in that list

}  // namespace aspic
