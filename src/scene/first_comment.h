// Description of a scene: the comment in its first line.
#pragma once
#include <filesystem>
#include <string>

namespace aspic {

// Returns the comment in the first line of `scene`, printable and without its "# "; empty if there is none.
std::string first_comment(const std::filesystem::path& scene);

}  // namespace aspic
