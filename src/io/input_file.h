// Opens foreign input only if it is a regular file: opening or reading a pipe may block forever.
#pragma once
#include <filesystem>
#include <fstream>

#include "base/function_ref.h"

namespace aspic {

std::ifstream open_input(const std::filesystem::path& path);  // throws InvalidInput
// The same, but returns a failed stream if the file is missing or not regular.
std::ifstream try_open_input(const std::filesystem::path& path);

// Checks a foreign folder before writing into it. Throws InvalidInput if a relevant entry, here or in a relevant
// subfolder, is a symbolic link, because writing would follow it, or if such a folder cannot be listed.
void refuse_links(const std::filesystem::path& folder, FunctionRef<bool(const std::filesystem::path&)> counts);

}  // namespace aspic
