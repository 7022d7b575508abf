// A scene for a mesh that comes alone.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene_builder.h"

namespace aspic {

// Pinned at its base, pulled sideways and let go. Every choice that the overrides leave is a note with its reason.
SceneSource scene_of_mesh(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                          MeshLoader& loader);

}  // namespace aspic
