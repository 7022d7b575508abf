// Files of a sequence.
#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

namespace aspic {

bool is_pattern(const std::filesystem::path& path);  // has a * in its last part

// Returns the files that match the pattern, or the file itself, in natural order: "scan_2.ply" before "scan_10.ply".
// Throws InvalidInput if there are none.
std::vector<std::filesystem::path> matching_files(const std::filesystem::path& pattern);

}  // namespace aspic
