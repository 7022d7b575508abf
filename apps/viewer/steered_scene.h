// A scene whose model has a mouse spring and the load of a tool, and changes of its settings.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "energy/grab_spring.h"
#include "scene/scene.h"
#include "scene/solver_options.h"
#include "scene/value.h"
#include "viewer/extension.h"

namespace aspic::viewer {

struct SteeredScene {
  Scene scene;
  GrabSpring* mouse = nullptr;  // a load of the model
  size_t mouse_load = 0;        // its index
  std::unique_ptr<SideTool> tool;
  size_t tool_load = 0;  // index of its load; mouse_load: none
  Table document;        // with all values
  std::filesystem::path path;
  std::vector<std::string> overrides;
};

// Throws InvalidInput, also for more tets than the options allow or than fit into a quarter of the free memory.
SteeredScene load_steered(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                          const Announce& announce, const SessionOptions& options);

// The change of one setting: a new solver, or the reloaded scene.
struct SceneChange {
  std::vector<std::string> overrides;
  Table document;
  std::optional<SteeredScene> reloaded;
  std::optional<SolverOptions> solver;
};
// Replaces the override of a key; a key alone drops its override. Throws InvalidInput.
SceneChange changed_scene(const SteeredScene& steered, const std::string& override_text, const Announce& announce,
                          const SessionOptions& options);

}  // namespace aspic::viewer
