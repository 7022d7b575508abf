// A scene with a mouse and a probe in it, and its document: loaded, or loaded again with other overrides.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "energy/grab_spring.h"
#include "energy/held_tip.h"
#include "scene/scene.h"
#include "scene/value.h"

namespace aspic::viewer {

struct SteeredScene {
  Scene scene;
  GrabSpring* mouse = nullptr;  // one of the model's loads
  size_t mouse_load = 0;        // which
  HeldTip* tip = nullptr;       // one of the model's loads
  size_t tip_load = 0;
  Table document;  // complete
  std::filesystem::path path;
  std::vector<std::string> overrides;
  double most_tets;
};

// Throws InvalidInput: for more tets than `most_tets`, too, or than fit into a quarter of the free memory.
SteeredScene load_steered(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                          const Announce& announce, double most_tets);

// A new value for a key of [solver] that no more than the solver depends on needs nothing to be loaded again.
bool is_of_solver_alone(const std::string& key);
// The document with one more override, checked. Throws InvalidInput.
Table overridden(const SteeredScene& steered, const std::string& override_text);

// k of the mouse's spring, about that of the tets that it pulls: E times the length of an edge [N/m]. A stiffer one
// would turn them inside out before the body follows.
double usual_stiffness(const Model& model);

}  // namespace aspic::viewer
