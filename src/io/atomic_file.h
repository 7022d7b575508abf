// Atomic file replacement: a temporary file beside the target, fsync, rename.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace aspic {

void write_file(const std::filesystem::path& path, std::string_view contents);  // throws InvalidInput (disk full, ...)
std::string read_file(const std::filesystem::path& path);  // throws InvalidInput if the file cannot be read

}  // namespace aspic
