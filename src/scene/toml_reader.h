// Reads TOML as a tree of values with places. Only this file uses the TOML library.
#pragma once
#include <filesystem>
#include <string>

#include "scene/value.h"

namespace aspic {

// Returns the text of a file of at most 16 MiB. Throws InvalidInput.
std::string read_toml_text(const std::filesystem::path& path);

// Throws InvalidInput "source:line:column: reason". Dates and times are refused.
Table read_toml(const std::string& text, const std::string& source);

// Reads one value, as on the right of "key = ". Its places are `source` without a line.
Value read_toml_value(const std::string& text, const std::string& source);

}  // namespace aspic
