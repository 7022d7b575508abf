// What the tests of scenes share: a cube, and ways to load a scene or to see why it is refused.
#pragma once
#include <cmath>
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

inline double distance(const Vec3d& a, const Vec3d& b) { return std::sqrt(dot(a - b, a - b)); }

}  // namespace aspic
