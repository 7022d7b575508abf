// TOML text to a tree of values with places; the only file that knows the TOML library.
#pragma once
#include <memory>
#include <string>

#include "scene/value.h"

namespace aspic {

// Throws InvalidInput "source:line:column: reason". Dates and times have no use in a scene and are refused.
Table read_toml(const std::string& text, const std::string& source);

// One value, as on the right of "key = ". Every place in it is `source` without a line.
Value read_toml_value(const std::string& text, const std::string& source);

}  // namespace aspic
