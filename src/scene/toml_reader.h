// TOML text to a tree of values with places; the only file that knows the TOML library.
#pragma once
#include <filesystem>
#include <string>

#include "scene/value.h"

namespace aspic {

// Of a file of at most 16 MiB: lists of vertices make scenes long, but not that long. Throws InvalidInput.
std::string read_toml_text(const std::filesystem::path& path);

// Throws InvalidInput "source:line:column: reason". Dates and times have no use in a scene and are refused.
Table read_toml(const std::string& text, const std::string& source);

// One value, as on the right of "key = ". Every place in it is `source` without a line.
Value read_toml_value(const std::string& text, const std::string& source);

}  // namespace aspic
