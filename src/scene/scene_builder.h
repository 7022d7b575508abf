// Builds a scene from a complete document.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "scene/body_mesh.h"
#include "scene/scene.h"
#include "scene/scene_model.h"
#include "scene/value.h"

namespace aspic {

struct SceneSource {
  Table document;                            // has passed read_scene_document()
  std::string name;                          // name of the scene
  std::string file;                          // file name for messages
  std::map<std::string, LoadedMesh> meshes;  // meshes of bodies that were already read
  std::vector<std::string> notes;
};

// Both throw InvalidInput.
SceneModel build_scene_model(SceneSource source, SceneFiles files, const SceneOptions& options);
Scene build_scene(SceneSource source, SceneFiles files, const SceneOptions& options);
// Returns the number of steps, from the checked table `time` of a scene.
int steps_of(const Value& time);

}  // namespace aspic
