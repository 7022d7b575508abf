// Scenes that a session offers to its pages.
#pragma once
#include <filesystem>
#include <vector>

#include "viewer/session.h"

namespace aspic::viewer {

// Returns all scenes below `folder`, those with a picture first, by name. The first comment line of each is its
// description. `folder`/gallery/NAME.webp is the picture of NAME.toml and of 01_NAME.toml.
std::vector<OfferedScene> scenes_below(const std::filesystem::path& folder);

}  // namespace aspic::viewer
