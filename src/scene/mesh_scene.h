// Makes a scene for a mesh without a scene.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene_builder.h"

namespace aspic {

// The body falls onto a floor. If it cannot have contact, or overrides ask for pins, an initial deformation or another
// integrator, it is pinned at its base, pulled sideways and released. Every default is a note with its reason.
SceneSource scene_of_mesh(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                          MeshLoader& loader);

}  // namespace aspic
