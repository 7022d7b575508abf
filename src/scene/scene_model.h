// A scene as a model with its initial state, for computations other than a Simulation.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/simulation.h"
#include "scene/scene.h"
#include "scene/value.h"

namespace aspic {

struct SceneModel {
  std::string name;                // see Scene
  Table document;                  // with all defaults
  std::vector<std::string> notes;  // see Scene
  std::vector<std::string> warnings;
  Model model;
  State start;
  SimulationOptions options;
  std::vector<std::pair<std::string, std::string>> input_files;        // see Scene
  std::vector<std::pair<std::string, TetMesh>> generated_meshes = {};  // see Scene
};

// Reads the same files as load_scene() and throws the same errors, except those of the initial state.
SceneModel load_scene_model(const std::filesystem::path& path, const SceneOptions& options = {});

}  // namespace aspic
