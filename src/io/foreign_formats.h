// Formats of other programs that are not read.
#pragma once
#include <string>
#include <string_view>

namespace aspic {

// Returns the name of the format with this extension, ".inp", and how to convert it; empty if it is unknown.
std::string remedy_for_foreign_format(std::string_view extension);

}  // namespace aspic
