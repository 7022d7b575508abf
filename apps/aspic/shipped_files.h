// Files that are shipped with the program.
#pragma once
#include <filesystem>

namespace aspic::cli {

// Searches `name` below the current folder, the program's folder, their parent folders, and the share folder of an
// installation. Returns an empty path if not found.
std::filesystem::path shipped_file(const std::filesystem::path& name);

}  // namespace aspic::cli
