// Files that appear whole or not at all: written to a temporary beside the target, fsync, rename.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace aspic {

void write_file(const std::filesystem::path& path, std::string_view contents);  // throws InvalidInput (disk full, ...)
std::string read_file(const std::filesystem::path& path);  // throws InvalidInput when it cannot be read

}  // namespace aspic
