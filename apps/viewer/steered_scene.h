// A scene whose model has a mouse spring and an indenter, and changes of its settings.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "energy/grab_spring.h"
#include "energy/held_indenter.h"
#include "scene/scene.h"
#include "scene/solver_options.h"
#include "scene/value.h"

namespace aspic::viewer {

struct SteeredScene {
  Scene scene;
  GrabSpring* mouse = nullptr;       // a load of the model
  size_t mouse_load = 0;             // its index
  HeldIndenter* indenter = nullptr;  // a load of the model
  size_t tip_load = 0;               // its index
  Table document;                    // with all values
  std::filesystem::path path;
  std::vector<std::string> overrides;
  double most_tets;
};

// Throws InvalidInput, also for more tets than `most_tets` or than fit into a quarter of the free memory.
SteeredScene load_steered(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                          const Announce& announce, double most_tets);

// The change of one setting: a new solver, or the reloaded scene.
struct SceneChange {
  std::vector<std::string> overrides;
  Table document;
  std::optional<SteeredScene> reloaded;
  std::optional<SolverOptions> solver;
};
// Replaces the override of a key; a key alone drops its override. Throws InvalidInput.
SceneChange changed_scene(const SteeredScene& steered, const std::string& override_text, const Announce& announce);

}  // namespace aspic::viewer
