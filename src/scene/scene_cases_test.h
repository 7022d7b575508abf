// Shared by tests of scenes: a cube, and functions that load a scene or return the message of its rejection.
#pragma once
#include <string>
#include <vector>

#include "base/error.h"
#include "io/folder_test.h"
#include "scene/scene.h"

namespace aspic {

inline const std::string kCube =
    "[[body]]\nname = \"cube\"\nshape = { box = { upper = [1, 1, 1], cells = [2, 2, 2] } }\n";

inline Scene load(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TestFolder folder;
  return load_scene(folder.write("beam.toml", text), {.overrides = overrides});
}

inline std::string refusal_of(const std::filesystem::path& path, const SceneOptions& options = {}) {
  try {
    load_scene(path, options);
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "";
}

inline std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TestFolder folder;
  return refusal_of(folder.write("beam.toml", text), {.overrides = overrides});
}

inline Vec3d vertex(const std::vector<double>& values, int i) {
  return {{values[3 * i], values[3 * i + 1], values[3 * i + 2]}};
}

// Positions and velocities, 3 per vertex, in the numbering of the scene's meshes.
inline std::vector<double> positions(const Scene& scene) {
  return scene.simulation.model().numbering.vertex.to_user(scene.simulation.state().q, 3);
}
inline std::vector<double> velocities(const Scene& scene) {
  return scene.simulation.model().numbering.vertex.to_user(scene.simulation.state().qdot, 3);
}
inline Vec3d rest(const Scene& scene, int vertex) {
  const Model& model = scene.simulation.model();
  return model.mesh.rest[model.numbering.vertex.from_user(vertex)];
}

inline double distance(const Vec3d& a, const Vec3d& b) { return norm(a - b); }

}  // namespace aspic
