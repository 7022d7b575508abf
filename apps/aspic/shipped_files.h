// Files that come with the program.
#pragma once
#include <filesystem>

namespace aspic::cli {

// `name` below the current folder, the program's folder, or one above these, or in the share folder of an installation
// there; empty where there is none.
std::filesystem::path shipped_file(const std::filesystem::path& name);

}  // namespace aspic::cli
